//! Slivers, needles and fans.

use std::sync::Arc;

use glam::Vec3;

use super::case::cases;
use super::set::{Set, indexed, moved, on_surface, ray_to, tilted};
use crate::geometry::{Mesh, Ray};
use crate::scene::meshes;
use crate::validate::Sampler;
use crate::validate::degenerate::{mesh, needles};

cases! {
    Moderate 35 "slivers_1e6_axis", Oracle => |n| slivers(n, |p| p),
        "Strips of 1000 x 1e-3 along the axes: a million times longer than wide.",
        "Woop, Benthin, Wald 2013: t is as accurate as the least accurate axis";
    Moderate 36 "slivers_1e6_rot", Oracle => |n| slivers(n, tilted),
        "The same strips tilted: the f32 normal has no digit left, and t is wrong by percents.",
        "Embree, stable_triangle_normal; measured: 36 to 44 % of the depths wrong";
    Moderate 37 "hair_diag", Oracle => hair,
        "Needles of 2 x 1e-3 along a diagonal: their boxes are almost empty, and all overlap.",
        "survey";
    // The apex is zero: it is aimed at exactly.
    Moderate 38 "fan_apex", Hit x 2000 => |n| Set::new(fan(), n, 14, |sampler| ray_to(below(sampler), Vec3::ZERO)),
        "800 triangles meet in the vertex that is aimed at: all of them hit, at edges, and none may fall out of its box.",
        "obvhs, rt_triangle.rs: seen from behind, 0 times a negative number is -0.0, and counts as outside";
    Moderate 39 "fan_random", Hit => |n| {
        Set::new(fan(), n, 15, |sampler| {
            ray_to(below(sampler), Vec3::new(sampler.signed(), sampler.signed(), 0.0) * 0.4)
        })
    },
        "The same fan, aimed at beside its apex.",
        "survey";
    Moderate 56 "needle_stack_kd", Oracle => |n| {
        Set::new(needles(2200), n, 16, |sampler| ray_to(sampler.direction() * 12.0, sampler.cube() * 3.0))
    },
        "Needles that cross in one place: no plane separates them, and every split doubles references.",
        "pbrt-v4, kd-tree: bad refines; Wald, Havran 2006";
}

/// A thousand strips side by side, over a field of 1000 x 1, from above.
fn slivers(count: usize, placed: fn(Vec3) -> Vec3) -> Set {
    const WIDTH: f32 = 1e-3;
    let points = (0..=1000).flat_map(|i| [0.0, 1000.0].map(|x| Vec3::new(x, i as f32 * WIDTH, 0.0)));
    let strips = (0..1000).map(|i| 2 * i).flat_map(|a: u32| [[a, a + 1, a + 3], [a, a + 3, a + 2]]);
    let flat = indexed(points.collect(), strips.collect());
    Set::new(moved(&flat, placed), count, 12, |sampler| {
        let target = Vec3::new(1000.0 * sampler.unit(), sampler.unit(), 0.0);
        let from = target + Vec3::new(sampler.signed(), sampler.signed(), 10.0 * (1.0 + sampler.unit()));
        Ray::new(placed(from), placed(target) - placed(from))
    })
}

fn hair(count: usize) -> Set {
    let mut sampler = Sampler::new(13);
    let hairs = (0..3000).map(|_| {
        let root = sampler.cube() * 2.0;
        [root, root + Vec3::splat(2.0 / 1.732_050_8), root + sampler.direction() * 1e-3]
    });
    let mesh = mesh(hairs);
    Set::new(mesh.clone(), count, 13, |sampler| ray_to(sampler.direction() * 8.0, on_surface(&mesh, sampler)))
}

fn fan() -> Arc<Mesh> {
    let fan = meshes::fan(800);
    indexed(fan.positions, fan.triangles)
}

/// A point from which the backs of the fan are seen.
fn below(sampler: &mut Sampler) -> Vec3 {
    Vec3::new(sampler.signed(), sampler.signed(), -3.0 - 2.0 * sampler.unit())
}
