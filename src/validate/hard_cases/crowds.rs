//! Many triangles that no plane separates: copies, common centroids, triangles without area.

use std::sync::Arc;

use glam::Vec3;

use super::case::cases;
use super::set::{Set, on_surface, ray_to};
use crate::geometry::Mesh;
use crate::validate::Sampler;
use crate::validate::degenerate::{TRIANGLE, half_without_area, mesh, same_centroid, soup, soup_triangles};

cases! {
    Moderate 40 "coincident_1000", Hit x 2000 => |n| copies(1000, n, 28),
        "A thousand copies of one triangle: the lowest number is owed, and nothing can be split.",
        "Embree, verify.cpp, overlapping_primitives";
    Moderate 41 "duplicates_20000", Hit x 200 => |n| copies(20_000, n, 28),
        "Builders that look for the nearest neighbour, or split without end, take quadratic time.",
        "obvhs, ploc: 17 to 32 s";
    Moderate 45 "degenerate_half", Oracle => |n| towards_surface(half_without_area(2000), n, 20),
        "Half of the triangles are points, needles or have a double corner: answers are those without them.",
        "tests of obvhs and Embree on degenerate input";
    Moderate 54 "same_centroid_2000", Oracle => |n| towards_surface(same_centroid(2000), n, 21),
        "All centroids in one point: a median split separates nothing and must stop.",
        "Hapala, Havran 2011; bvh crates with a fixed stack";
    Moderate 64 "soup_random", Oracle => |n| towards_surface(soup(2000, 22), n, 22),
        "Random triangles and rays: the ground against which the other cases stand.",
        "survey";
    Added 78 "zfighting_ulp_copies", Oracle x 2000 => |n| towards_surface(ulp_copies(), n, 24),
        "Copies an ulp apart: the nearest is decided below the rounding of t.",
        "survey";
    Added 80 "collinear_line", Oracle => on_a_line,
        "Boxes without extent in one or two axes: a half area of 0 divides by zero in cost models.",
        "Wald, Havran 2006; Hapala, Havran 2011";
    Added 82 "median_matches_heavy", Oracle => |n| towards_surface(mostly_centred(), n, 27),
        "More than half of the centroids equal the median: `less than` and `not less than` must both shrink.",
        "the report's own median tree; survey";
}

/// One triangle `copies` times, aimed at well inside.
pub(super) fn copies(copies: usize, count: usize, seed: u64) -> Set {
    let [a, b, c] = TRIANGLE;
    Set::new(mesh(std::iter::repeat_n(TRIANGLE, copies)), count, seed, |sampler| {
        let [u, v, w] = sampler.barycentric().map(|weight| 0.2 + 0.4 * weight);
        let origin = Vec3::new(sampler.signed(), sampler.signed(), 4.0 * sampler.sign());
        ray_to(origin, a * u + b * v + c * w)
    })
}

fn ulp_copies() -> Arc<Mesh> {
    let mut sampler = Sampler::new(23);
    let mut shift = |x: f32| match sampler.below(3) {
        0 => x.next_down(),
        1 => x,
        _ => x.next_up(),
    };
    mesh((0..500).map(|_| TRIANGLE.map(|p| Vec3::from_array(p.to_array().map(&mut shift)))))
}

/// Needles without area along a line, and among them slivers that have one.
fn on_a_line(count: usize) -> Set {
    let on_line = |i: usize, step: f32| Vec3::new(i as f32 * 0.125 + step, 0.0, 0.0);
    let triangles = (0..400).map(|i| {
        let lift = if i % 4 == 0 { Vec3::Z * 0.001 } else { Vec3::ZERO };
        [on_line(i, 0.0), on_line(i, 1.0), on_line(i, 0.5) + lift]
    });
    Set::new(mesh(triangles), count, 25, |sampler| {
        let target = Vec3::new(50.0 * sampler.unit(), 0.0, 0.001 * sampler.unit());
        ray_to(target + Vec3::new(sampler.signed(), sampler.sign(), sampler.signed()), target)
    })
}

fn mostly_centred() -> Arc<Mesh> {
    let mut sampler = Sampler::new(26);
    let alike = (0..1400).map(|_| {
        // On a grid, the centroid is zero exactly.
        let [a, b] = [0; 2].map(|_| (sampler.cube() * 64.0).round() / 64.0);
        [a, b, -a - b]
    });
    mesh(alike.chain(soup_triangles(600, 26)))
}

/// From around the mesh towards its triangles.
fn towards_surface(mesh: Arc<Mesh>, count: usize, seed: u64) -> Set {
    let (centre, reach) = (mesh.bounds().centre(), mesh.bounds().extent().max_element());
    Set::new(mesh.clone(), count, seed, |sampler| {
        ray_to(centre + sampler.direction() * reach, on_surface(&mesh, sampler))
    })
}
