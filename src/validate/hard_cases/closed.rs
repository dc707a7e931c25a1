//! Closed meshes from inside, near zero and far from it: every ray hits.

use glam::Vec3;

use super::case::cases;
use super::set::{Set, inside, moved, on_edge, sphere, star, triangle};
use crate::geometry::{Mesh, Ray};
use crate::validate::Sampler;

cases! {
    Moderate 1 "closed_random", Hit => |n| in_star(n, |_, sampler, _| sampler.direction()),
        "Random rays inside a spiky closed star: the least that watertight means.",
        "pbrt-v4, shapes_test.cpp, Triangle.Watertight";
    Moderate 2 "closed_vertex", Hit => |n| in_star(n, |mesh, sampler, origin| vertex(mesh, sampler) - origin),
        "At a vertex every triangle around it may say no by its own rounding, and the ray leaks out.",
        "pbrt-v4, Triangle.Watertight; Embree issues 174 and 181; obvhs, rt_triangle.rs: -0.0 counts as outside";
    Moderate 3 "closed_edge", Hit => |n| in_star(n, |mesh, sampler, origin| on_edge(mesh, sampler) - origin),
        "At an edge both triangles may say no when their edge functions round differently.",
        "Woop, Benthin, Wald 2013";
    Moderate 14 "offset_1e3", Hit => |n| in_sphere(n, Vec3::splat(1e3), 1.0),
        "A unit sphere at 1e3: tests that store planes in absolute coordinates lose their digits.",
        "measured: Baldwin-Weber in f32 misses 43 %";
    Moderate 15 "offset_embree_1.5e5", Hit => |n| in_sphere(n, Vec3::new(148_376.0, 1234.0, -223_423.0), 2.0),
        "Where Embree's own watertight test puts its sphere; its default mode leaks there.",
        "Embree, verify.cpp, watertight tests, run in robust mode only";
    Moderate 16 "offset_1e6", Hit => |n| in_sphere(n, Vec3::new(1e6, -1e6, 1e6), 10.0),
        "A slab test of the form bound * inverse - origin * inverse cancels far from zero.",
        "Embree, node_intersector1.h; madmann91/bvh, intersect_fast";
    Moderate 17 "offset_1e7", Hit => |n| in_sphere(n, Vec3::new(-1e7, 1e7, 1e7), 100.0),
        "An ulp is a unit there: coordinates of rays, boxes and planes often coincide.",
        "measured: truncating the near interval at a plane through the origin lost 2 to 27 % of the rays";
    Moderate 33 "dir_nearly_axis_1e-9", Hit => |n| in_star(n, |_, sampler, _| nearly_axis(sampler, 1e-9)),
        "Two direction components of 1e-9: inverses are huge, and clamps of small components bend the ray.",
        "obvhs, ray.rs, safe_inverse; tinybvh, tinybvh_safercp";
    Moderate 34 "dir_nearly_axis_1e-30", Hit => |n| in_star(n, |_, sampler, _| nearly_axis(sampler, 1e-30)),
        "Two direction components of 1e-30: products with them underflow.",
        "Embree, zero_fix: components below 1e-18 lose their sign";
}

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

fn vertex(mesh: &Mesh, sampler: &mut Sampler) -> Vec3 {
    let corners = triangle(mesh, sampler);
    sampler.pick(&corners)
}
