//! Rays that are none: nothing may be hit, and nothing may take long.

use glam::Vec3;

use super::case::cases;
use super::set::{Set, ray_to, star};
use crate::geometry::Ray;
use crate::validate::Sampler;

const NAN: f32 = f32::NAN;
const TIME: &str = "Embree, verify.cpp, nan_test and inf_test: time below 2.5 times that of valid rays";

cases! {
    Unranked 65 "rays_nan_origin", Miss x 1000 => |n| spoilt(n, |sampler, ray| ray.origin[sampler.below(3)] = NAN),
        "NaN in the origin: comparisons with it are false, and code that drops NaN walks the whole tree.",
        TIME;
    Unranked 66 "rays_nan_dir", Miss x 1000 => |n| spoilt(n, |sampler, ray| ray.direction[sampler.below(3)] = NAN),
        "NaN in the direction.",
        TIME;
    Unranked 67 "rays_inf_origin", Miss x 1000 => |n| {
        spoilt(n, |sampler, ray| ray.origin[sampler.below(3)] = infinity(sampler))
    },
        "An infinite origin: differences are infinite, and the difference of two such is NaN.",
        TIME;
    Unranked 68 "rays_inf_dir", Miss x 1000 => |n| {
        spoilt(n, |sampler, ray| ray.direction[sampler.below(3)] = infinity(sampler))
    },
        "An infinite direction component: its inverse is 0, and every t comes out as 0 or NaN.",
        "parry: a hit at t = 0 for every ray";
    Unranked 69 "rays_zero_dir", Miss x 1000 => |n| {
        spoilt(n, |sampler, ray| ray.direction = Vec3::new(sampler.zero(), sampler.zero(), sampler.zero()))
    },
        "No direction: a point inside every box that contains it.",
        "kdtree-ray: 8 times the time; parry, CHANGELOG: clip_aabb_line";
    Unranked 70 "rays_tmin_gt_tmax", Miss x 1000 => |n| {
        spoilt(n, |sampler, ray| (ray.t_min, ray.t_max) = (2.0, sampler.unit()))
    },
        "The interval ends before it begins.",
        "Embree, verify.cpp, inactive_rays";
    Unranked 71 "rays_nan_interval", Miss x 1000 => |n| spoilt(n, spoil_interval),
        "An interval that begins or ends at NaN.",
        TIME;
}

fn infinity(sampler: &mut Sampler) -> f32 {
    sampler.sign() * f32::INFINITY
}

fn spoil_interval(sampler: &mut Sampler, ray: &mut Ray) {
    match sampler.below(3) {
        0 => ray.t_min = NAN,
        1 => ray.t_max = NAN,
        _ => (ray.t_min, ray.t_max) = (NAN, NAN),
    }
}

/// Rays through the star, each made invalid; the same as they were serve as ordinary ones.
fn spoilt(count: usize, spoil: fn(&mut Sampler, &mut Ray)) -> Set {
    let mut ordinary = vec![];
    let set = Set::new(star(), count, 60, |sampler| {
        let ray = ray_to(sampler.direction() * 8.0, sampler.cube() * 3.0);
        ordinary.push(ray);
        let mut spoilt = ray;
        spoil(sampler, &mut spoilt);
        spoilt
    });
    Set { ordinary, ..set }
}
