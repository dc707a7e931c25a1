//! Rays that are none: nothing may be hit, and nothing may take long.

use glam::Vec3;

use super::case::{HardCase, unranked};
use super::set::{Set, star};
use crate::geometry::Ray;
use crate::validate::Sampler;

const NAN: f32 = f32::NAN;
const TIME: &str = "Embree, verify.cpp, nan_test and inf_test: time below 2.5 times that of valid rays";

pub(super) const CASES: &[HardCase] = &[
    unranked(65, "rays_nan_origin")
        .all_miss(|n| spoilt(n, |sampler, ray| ray.origin[sampler.below(3)] = NAN))
        .at_most(1000)
        .because("NaN in the origin: comparisons with it are false, and code that drops NaN walks the whole tree.")
        .source(TIME),
    unranked(66, "rays_nan_dir")
        .all_miss(|n| spoilt(n, |sampler, ray| ray.direction[sampler.below(3)] = NAN))
        .at_most(1000)
        .because("NaN in the direction.")
        .source(TIME),
    unranked(67, "rays_inf_origin")
        .all_miss(|n| spoilt(n, |sampler, ray| ray.origin[sampler.below(3)] = infinity(sampler)))
        .at_most(1000)
        .because("An infinite origin: differences are infinite, and the difference of two such is NaN.")
        .source(TIME),
    unranked(68, "rays_inf_dir")
        .all_miss(|n| spoilt(n, |sampler, ray| ray.direction[sampler.below(3)] = infinity(sampler)))
        .at_most(1000)
        .because("An infinite direction component: its inverse is 0, and every t comes out as 0 or NaN.")
        .source("parry: a hit at t = 0 for every ray"),
    unranked(69, "rays_zero_dir")
        .all_miss(|n| {
            spoilt(n, |sampler, ray| ray.direction = Vec3::new(sampler.zero(), sampler.zero(), sampler.zero()))
        })
        .at_most(1000)
        .because("No direction: a point inside every box that contains it.")
        .source("kdtree-ray: 8 times the time; parry, CHANGELOG: clip_aabb_line"),
    unranked(70, "rays_tmin_gt_tmax")
        .all_miss(|n| spoilt(n, |sampler, ray| (ray.t_min, ray.t_max) = (2.0, sampler.unit())))
        .at_most(1000)
        .because("The interval ends before it begins.")
        .source("Embree, verify.cpp, inactive_rays"),
    unranked(71, "rays_nan_interval")
        .all_miss(|n| {
            spoilt(n, |sampler, ray| match sampler.below(3) {
                0 => ray.t_min = NAN,
                1 => ray.t_max = NAN,
                _ => (ray.t_min, ray.t_max) = (NAN, NAN),
            })
        })
        .at_most(1000)
        .because("An interval that begins or ends at NaN.")
        .source(TIME),
];

fn infinity(sampler: &mut Sampler) -> f32 {
    sampler.sign() * f32::INFINITY
}

/// Rays through the star, each made invalid; the same as they were serve as ordinary ones.
fn spoilt(count: usize, spoil: fn(&mut Sampler, &mut Ray)) -> Set {
    let mut ordinary = vec![];
    let set = Set::new(star(), count, 60, |sampler| {
        let origin = sampler.direction() * 8.0;
        let ray = Ray::new(origin, sampler.cube() * 3.0 - origin);
        ordinary.push(ray);
        let mut spoilt = ray;
        spoil(sampler, &mut spoilt);
        spoilt
    });
    Set { ordinary, ..set }
}
