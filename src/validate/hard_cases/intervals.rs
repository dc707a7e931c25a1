//! Where the interval of a ray begins and ends, and rays that begin at a surface.

use glam::Vec3;

use super::case::{HardCase, added, moderate, unranked};
use super::set::{Set, indexed, moved, on_surface, sheet, sphere};
use crate::geometry::Ray;
use crate::validate::Sampler;
use crate::validate::degenerate::{box_grid, soup};

pub(super) const CASES: &[HardCase] = &[
    unranked(58, "tmin_tmax_window")
        .all_hit(windows)
        .because("Intervals that hold only the first, or only the second crossing of a sphere.")
        .source("parry: has no t_min"),
    unranked(59, "tmax_exact_hit")
        .all_miss(|n| to_the_lid(n, |t| (0.0, t)))
        .because("The only hit is at t_max exactly: the interval is half-open, so nothing is hit. Others close it.")
        .source("Embree, CHANGELOG: robust mode is closed; obvhs half-open, as here"),
    unranked(60, "tmin_exact_hit")
        .all_hit(|n| to_the_lid(n, |t| (t, f32::INFINITY)))
        .because("The only hit is at t_min exactly, which belongs to the interval. Others leave it out.")
        .source("Embree, default mode: T > tnear"),
    moderate(61, "tiny_t_near_surface")
        .all_hit(|n| {
            Set::new(sheet(32), n, 50, |sampler| {
                let height = sampler.pick(&[1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7]);
                Ray::new(Vec3::new(sampler.signed(), sampler.signed(), height), Vec3::new(0.0, 0.0, -1.0))
            })
        })
        .because("From 1e-1 to 1e-7 above a surface: absolute epsilons lose the nearest hits.")
        .source("obvhs, CwBvh node.rs EPSILON = 1e-4"),
    unranked(62, "origin_on_surface")
        .all_hit(on_a_sheet)
        .because("The origin lies on a triangle exactly: the hit is at t = 0, before the sheet below.")
        .source("svenstaro/bvh and Embree leave t = 0 out"),
    moderate(63, "origin_in_aabb_face")
        .by_oracle(|n| {
            let mesh = soup(2000, 22);
            Set::new(mesh.clone(), n, 52, |sampler| {
                let (bounds, axis) = (mesh.bounds(), sampler.below(3));
                let mut origin = bounds.centre() + bounds.extent() * 0.5 * sampler.cube();
                origin[axis] = if sampler.coin() { bounds.min[axis] } else { bounds.max[axis] };
                Ray::new(origin, on_surface(&mesh, sampler) - origin)
            })
        })
        .because("The origin lies in a face of the root box: entry is at t = 0 exactly, and must not count as behind.")
        .source("Hapala, Havran 2011: the ray's origin in a plane"),
    added(72, "secondary_rays")
        .by_oracle(|n| {
            let mesh = sphere(50, 50);
            Set::new(mesh.clone(), n, 53, |sampler| {
                let origin = on_surface(&mesh, sampler);
                let direction = sampler.direction();
                Ray::new(origin, if direction.dot(origin) < 0.0 { -direction } else { direction })
            })
        })
        .because(
            "Rays that leave a surface from where rounding puts the point: half of them lie below it and hit it again.",
        )
        .source("Wächter, Binder 2019; pbrt-v4, Triangle.Reintersect"),
];

/// Through a sphere, by the first or the second crossing only.
fn windows(count: usize) -> Set {
    Set::new(sphere(50, 50), count, 54, |sampler| {
        let origin = sampler.direction() * 3.0;
        let middle = sampler.cube() * 0.3;
        let ray = Ray::new(origin, middle - origin);
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

/// From a sheet down to another.
fn on_a_sheet(count: usize) -> Set {
    let (upper, lower) = (sheet(16), moved(&sheet(16), |p| p * 4.0 - Vec3::Z));
    let points: Vec<Vec3> = upper.positions().iter().chain(lower.positions()).copied().collect();
    let above = upper.positions().len() as u32;
    let triangles = upper.triangles().iter().copied().chain(lower.triangles().iter().map(|t| t.map(|i| i + above)));
    Set::new(indexed(points, triangles.collect()), count, 55, |sampler| {
        let origin = Vec3::new(sampler.signed(), sampler.signed(), 0.0);
        Ray::new(origin, Vec3::new(sampler.signed(), sampler.signed(), -1.0))
    })
}
