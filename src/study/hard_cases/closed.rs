//! Closed meshes from inside, near zero and far from it: every ray hits.

use glam::Vec3;

use super::set::{inside, moved, sphere, star, triangle};
use super::{Content, HardCase, Rank, Set};
use crate::geometry::{Mesh, Ray};
use crate::validate::Sampler;

pub(super) const CASES: &[HardCase] = &[
    HardCase {
        number: 1,
        name: "closed_random",
        rank: Rank::Moderate,
        content: Content::hit(|n| in_star(n, |_, sampler, _| sampler.direction())),
        reason: "Random rays inside a spiky closed star: the least that watertight means.",
        source: "pbrt-v4, shapes_test.cpp, Triangle.Watertight",
    },
    HardCase {
        number: 2,
        name: "closed_vertex",
        rank: Rank::Moderate,
        content: Content::hit(|n| {
            in_star(n, |mesh, sampler, origin| {
                let corners = triangle(mesh, sampler);
                sampler.pick(&corners) - origin
            })
        }),
        reason: "At a vertex every triangle around it may say no by its own rounding, and the ray leaks out.",
        source: "pbrt-v4, Triangle.Watertight; Embree issues 174 and 181; obvhs, rt_triangle.rs: -0.0 counts as outside",
    },
    HardCase {
        number: 3,
        name: "closed_edge",
        rank: Rank::Moderate,
        content: Content::hit(|n| {
            in_star(n, |mesh, sampler, origin| {
                let [a, b, _] = triangle(mesh, sampler);
                a.lerp(b, sampler.unit()) - origin
            })
        }),
        reason: "At an edge both triangles may say no when their edge functions round differently.",
        source: "Woop, Benthin, Wald 2013",
    },
    HardCase {
        number: 14,
        name: "offset_1e3",
        rank: Rank::Moderate,
        content: Content::hit(|n| in_sphere(n, Vec3::splat(1e3), 1.0)),
        reason: "A unit sphere at 1e3: tests that store planes in absolute coordinates lose their digits.",
        source: "measured: Baldwin-Weber in f32 misses 43 %",
    },
    HardCase {
        number: 15,
        name: "offset_embree_1.5e5",
        rank: Rank::Moderate,
        content: Content::hit(|n| in_sphere(n, Vec3::new(148_376.0, 1234.0, -223_423.0), 2.0)),
        reason: "Where Embree's own watertight test puts its sphere; its default mode leaks there.",
        source: "Embree, verify.cpp, watertight tests, run in robust mode only",
    },
    HardCase {
        number: 16,
        name: "offset_1e6",
        rank: Rank::Moderate,
        content: Content::hit(|n| in_sphere(n, Vec3::new(1e6, -1e6, 1e6), 10.0)),
        reason: "A slab test of the form bound * inverse - origin * inverse cancels far from zero.",
        source: "Embree, node_intersector1.h; madmann91/bvh, intersect_fast",
    },
    HardCase {
        number: 17,
        name: "offset_1e7",
        rank: Rank::Moderate,
        content: Content::hit(|n| in_sphere(n, Vec3::new(-1e7, 1e7, 1e7), 100.0)),
        reason: "An ulp is a unit there: coordinates of rays, boxes and planes often coincide.",
        source: "measured: truncating the near interval at a plane through the origin lost 2 to 27 % of the rays",
    },
    HardCase {
        number: 33,
        name: "dir_nearly_axis_1e-9",
        rank: Rank::Moderate,
        content: Content::hit(|n| in_star(n, |_, sampler, _| nearly_axis(sampler, 1e-9))),
        reason: "Two direction components of 1e-9: inverses are huge, and clamps of small components bend the ray.",
        source: "obvhs, ray.rs, safe_inverse; tinybvh, tinybvh_safercp",
    },
    HardCase {
        number: 34,
        name: "dir_nearly_axis_1e-30",
        rank: Rank::Moderate,
        content: Content::hit(|n| in_star(n, |_, sampler, _| nearly_axis(sampler, 1e-30))),
        reason: "Two direction components of 1e-30: products with them underflow.",
        source: "Embree, zero_fix: components below 1e-18 lose their sign",
    },
];

fn in_star(count: usize, direction: impl Fn(&Mesh, &mut Sampler, Vec3) -> Vec3) -> Set {
    let mesh = star();
    let ray = |sampler: &mut Sampler| {
        let origin = inside(sampler);
        Ray::new(origin, direction(&mesh, sampler, origin))
    };
    Set::new(mesh.clone(), count, 1, ray)
}

/// From at most half the radius away from the centre. The vertices are rounded where they come to lie: the surface stays closed.
fn in_sphere(count: usize, centre: Vec3, radius: f32) -> Set {
    let mesh = moved(&sphere(50, 50), |p| centre + p * radius);
    Set::new(mesh, count, 2, |sampler| Ray::new(centre + inside(sampler) * radius, sampler.direction()))
}

fn nearly_axis(sampler: &mut Sampler, tiny: f32) -> Vec3 {
    let mut direction = sampler.cube() * tiny;
    direction[sampler.below(3)] = sampler.sign();
    direction
}
