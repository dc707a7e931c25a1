//! Many triangles that no plane separates: copies, common centroids, triangles without area.

use glam::Vec3;

use super::case::{HardCase, added, moderate};
use super::set::{Set, on_surface};
use crate::geometry::Ray;
use crate::validate::Sampler;
use crate::validate::degenerate::{TRIANGLE, half_without_area, mesh, same_centroid, soup, soup_triangles};

pub(super) const CASES: &[HardCase] = &[
    moderate(40, "coincident_1000")
        .all_hit(|n| copies(1000, n))
        .at_most(2000)
        .because("A thousand copies of one triangle: the lowest number is owed, and nothing can be split.")
        .source("Embree, verify.cpp, overlapping_primitives"),
    moderate(41, "duplicates_20000")
        .all_hit(|n| copies(20_000, n))
        .at_most(200)
        .because("Builders that look for the nearest neighbour, or split without end, take quadratic time.")
        .source("obvhs, ploc: 17 to 32 s"),
    moderate(45, "degenerate_half")
        .by_oracle(|n| towards_surface(half_without_area(2000), n, 20))
        .because("Half of the triangles are points, needles or have a double corner: answers are those without them.")
        .source("tests of obvhs and Embree on degenerate input"),
    moderate(54, "same_centroid_2000")
        .by_oracle(|n| towards_surface(same_centroid(2000), n, 21))
        .because("All centroids in one point: a median split separates nothing and must stop.")
        .source("Hapala, Havran 2011; bvh crates with a fixed stack"),
    moderate(64, "soup_random")
        .by_oracle(|n| towards_surface(soup(2000, 22), n, 22))
        .because("Random triangles and rays: the ground against which the other cases stand.")
        .source("survey"),
    added(78, "zfighting_ulp_copies")
        .by_oracle(|n| {
            let mut sampler = Sampler::new(23);
            let copies: Vec<_> = (0..500)
                .map(|_| {
                    TRIANGLE.map(|p| {
                        let shift = |x: f32| match sampler.below(3) {
                            0 => x.next_down(),
                            1 => x,
                            _ => x.next_up(),
                        };
                        Vec3::from_array(p.to_array().map(shift))
                    })
                })
                .collect();
            towards_surface(mesh(copies), n, 24)
        })
        .at_most(2000)
        .because("Copies an ulp apart: the nearest is decided below the rounding of t.")
        .source("survey"),
    added(80, "collinear_line")
        .by_oracle(|n| {
            // Needles without area along a line, and among them slivers that have one.
            let on_line = |i: usize, step: f32| Vec3::new(i as f32 * 0.125 + step, 0.0, 0.0);
            let triangles = (0..400).map(|i| {
                let lift = if i % 4 == 0 { Vec3::Z * 0.001 } else { Vec3::ZERO };
                [on_line(i, 0.0), on_line(i, 1.0), on_line(i, 0.5) + lift]
            });
            Set::new(mesh(triangles), n, 25, |sampler| {
                let target = Vec3::new(50.0 * sampler.unit(), 0.0, 0.001 * sampler.unit());
                let origin = target + Vec3::new(sampler.signed(), sampler.sign(), sampler.signed());
                Ray::new(origin, target - origin)
            })
        })
        .because("Boxes without extent in one or two axes: a half area of 0 divides by zero in cost models.")
        .source("Wald, Havran 2006; Hapala, Havran 2011"),
    added(82, "median_matches_heavy")
        .by_oracle(|n| {
            let mut sampler = Sampler::new(26);
            let alike: Vec<[Vec3; 3]> = (0..1400)
                .map(|_| {
                    // On a grid, the centroid is zero exactly.
                    let [a, b] = [0; 2].map(|_| (sampler.cube() * 64.0).round() / 64.0);
                    [a, b, -a - b]
                })
                .collect();
            towards_surface(mesh(alike.into_iter().chain(soup_triangles(600, 26))), n, 27)
        })
        .because("More than half of the centroids equal the median: `less than` and `not less than` must both shrink.")
        .source("the report's own median tree; survey"),
];

/// One triangle `copies` times, aimed at well inside.
fn copies(copies: usize, count: usize) -> Set {
    let [a, b, c] = TRIANGLE;
    Set::new(mesh(std::iter::repeat_n(TRIANGLE, copies)), count, 28, |sampler| {
        let [u, v, w] = sampler.barycentric().map(|weight| 0.2 + 0.4 * weight);
        let origin = Vec3::new(sampler.signed(), sampler.signed(), 4.0 * sampler.sign());
        Ray::new(origin, a * u + b * v + c * w - origin)
    })
}

/// From around the mesh towards its triangles.
fn towards_surface(mesh: std::sync::Arc<crate::geometry::Mesh>, count: usize, seed: u64) -> Set {
    let reach = mesh.bounds().extent().max_element();
    let centre = mesh.bounds().centre();
    Set::new(mesh.clone(), count, seed, |sampler| {
        let origin = centre + sampler.direction() * reach;
        Ray::new(origin, on_surface(&mesh, sampler) - origin)
    })
}
