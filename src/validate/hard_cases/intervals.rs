//! Where the interval of a ray begins and ends, and rays that begin at a surface.

use glam::Vec3;

use super::case::cases;
use super::set::{Set, joined, moved, on_surface, ray_to, sheet, sphere};
use crate::geometry::Ray;
use crate::validate::Sampler;
use crate::validate::degenerate::{box_grid, soup};

cases! {
    Unranked 58 "tmin_tmax_window", Hit => windows,
        "Intervals that hold only the first, or only the second crossing of a sphere.",
        "parry: has no t_min";
    Unranked 59 "tmax_exact_hit", Miss => |n| to_the_lid(n, |t| (0.0, t)),
        "The only hit is at t_max exactly: the interval is half-open, so nothing is hit. Others close it.",
        "Embree, CHANGELOG: robust mode is closed; obvhs half-open, as here";
    Unranked 60 "tmin_exact_hit", Hit => |n| to_the_lid(n, |t| (t, f32::INFINITY)),
        "The only hit is at t_min exactly, which belongs to the interval. Others leave it out.",
        "Embree, default mode: T > tnear";
    Moderate 61 "tiny_t_near_surface", Hit => just_above,
        "From 1e-1 to 1e-7 above a surface: absolute epsilons lose the nearest hits.",
        "obvhs, CwBvh node.rs EPSILON = 1e-4";
    Unranked 62 "origin_on_surface", Hit => on_a_sheet,
        "The origin lies on a triangle exactly: the hit is at t = 0, before the sheet below.",
        "svenstaro/bvh and Embree leave t = 0 out";
    Moderate 63 "origin_in_aabb_face", Oracle => from_the_root_box,
        "The origin lies in a face of the root box: entry is at t = 0 exactly, and must not count as behind.",
        "Hapala, Havran 2011: the ray's origin in a plane";
    Added 72 "secondary_rays", Oracle => off_a_sphere,
        "Rays that leave a surface from where rounding puts the point: half of them lie below it and hit it again.",
        "Wächter, Binder 2019; pbrt-v4, Triangle.Reintersect";
}

/// Through a sphere, by the first or the second crossing only.
fn windows(count: usize) -> Set {
    Set::new(sphere(50, 50), count, 54, |sampler| {
        let ray = ray_to(sampler.direction() * 3.0, sampler.cube() * 0.3);
        if sampler.coin() { ray.until(1.0) } else { Ray { t_min: 1.0, ..ray } }
    })
}

/// From within a cube to its upper face, in steps so simple that t is known: the interval is a function of it.
fn to_the_lid(count: usize, interval: fn(f32) -> (f32, f32)) -> Set {
    Set::new(box_grid(4), count, 51, |sampler| {
        let grid = |sampler: &mut Sampler| sampler.below(65) as f32 / 64.0 - 0.5;
        let origin = Vec3::new(grid(sampler), grid(sampler), grid(sampler));
        let direction = Vec3::new(0.25 * grid(sampler), 0.25 * grid(sampler), 0.5);
        let (t_min, t_max) = interval((1.0 - origin.z) * 2.0);
        Ray { t_min, t_max, ..Ray::new(origin, direction) }
    })
}

fn just_above(count: usize) -> Set {
    Set::new(sheet(32), count, 50, |sampler| {
        let height = sampler.pick(&[1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7]);
        Ray::new(Vec3::new(sampler.signed(), sampler.signed(), height), Vec3::NEG_Z)
    })
}

fn from_the_root_box(count: usize) -> Set {
    let mesh = soup(2000, 22);
    Set::new(mesh.clone(), count, 52, |sampler| {
        let (bounds, axis) = (mesh.bounds(), sampler.below(3));
        let mut origin = bounds.centre() + bounds.extent() * 0.5 * sampler.cube();
        origin[axis] = if sampler.coin() { bounds.min[axis] } else { bounds.max[axis] };
        ray_to(origin, on_surface(&mesh, sampler))
    })
}

fn off_a_sphere(count: usize) -> Set {
    let mesh = sphere(50, 50);
    Set::new(mesh.clone(), count, 53, |sampler| {
        let (origin, direction) = (on_surface(&mesh, sampler), sampler.direction());
        Ray::new(origin, if direction.dot(origin) < 0.0 { -direction } else { direction })
    })
}

/// From a sheet down to another.
fn on_a_sheet(count: usize) -> Set {
    let lower = moved(&sheet(16), |p| p * 4.0 - Vec3::Z);
    Set::new(joined(&sheet(16), &lower), count, 55, |sampler| {
        let origin = Vec3::new(sampler.signed(), sampler.signed(), 0.0);
        Ray::new(origin, Vec3::new(sampler.signed(), sampler.signed(), -1.0))
    })
}
