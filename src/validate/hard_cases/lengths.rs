//! Scenes and directions of extreme lengths.

use super::case::{HardCase, extreme, moderate};
use super::set::{Set, inside, moved, star};
use crate::geometry::Ray;

const OVERFLOW: &str = "Embree, FLT_LARGE; measured: every peer of f32 misses or misplaces all";

pub(super) const CASES: &[HardCase] = &[
    extreme(18, "scale_1e-40")
        .all_hit(|n| scaled(n, 1e-40))
        .because("Coordinates are denormal: every product of two of them is zero.")
        .source("measured: every f32 system misses all"),
    extreme(19, "scale_1e-30")
        .all_hit(|n| scaled(n, 1e-30))
        .because("Products of two lengths underflow to zero.")
        .source("measured: every f32 system misses all"),
    extreme(20, "scale_1e-20")
        .all_hit(|n| scaled(n, 1e-20))
        .because("Products of two lengths are denormal: their digits are gone.")
        .source("measured: every f32 system misses all"),
    moderate(21, "scale_1e-10")
        .all_hit(|n| scaled(n, 1e-10))
        .because("Absolute epsilons on determinants and distances swallow the whole scene.")
        .source("tinybvh pull request 283; obvhs, CwBvh node.rs EPSILON"),
    moderate(22, "scale_1e-5")
        .all_hit(|n| scaled(n, 1e-5))
        .because("The same at a scale that models in metres have.")
        .source("tinybvh pull request 283; obvhs, CwBvh node.rs EPSILON"),
    moderate(23, "scale_1e5")
        .all_hit(|n| scaled(n, 1e5))
        .because("Absolute epsilons that are too small here are no epsilons.")
        .source("Wächter, Binder 2019"),
    moderate(23, "scale_1e10")
        .all_hit(|n| scaled(n, 1e10))
        .because("Products of three lengths come near the end of the range.")
        .source("Embree, FLT_LARGE"),
    extreme(24, "scale_1e15")
        .all_hit(|n| scaled(n, 1e15))
        .because("Products of three lengths overflow.")
        .source(OVERFLOW),
    extreme(25, "scale_1e18")
        .all_hit(|n| scaled(n, 1e18))
        .because("Areas come near the end of the range, products of three lengths overflow.")
        .source(OVERFLOW),
    extreme(26, "dirlen_1e-30")
        .all_hit(|n| long(n, 1e-30))
        .because(
            "t is measured in lengths of the direction, which need not be 1: clamps of small components lose the ray.",
        )
        .source("obvhs, safe_inverse; Embree, zero_fix"),
    extreme(27, "dirlen_1e-20")
        .all_hit(|n| long(n, 1e-20))
        .because("As above, where squares of the direction underflow.")
        .source("obvhs, safe_inverse; Embree, zero_fix"),
    moderate(28, "dirlen_1e-10")
        .all_hit(|n| long(n, 1e-10))
        .because("As above, below the machine epsilon, which some take for zero.")
        .source("obvhs, safe_inverse: 1.19e-7"),
    moderate(29, "dirlen_1e-6")
        .all_hit(|n| long(n, 1e-6))
        .because("As above: only small components fall below the machine epsilon, so only some rays bend.")
        .source("obvhs, safe_inverse: 1.19e-7"),
    moderate(30, "dirlen_1e6")
        .all_hit(|n| long(n, 1e6))
        .because("Hits lie at t of 1e-6: below an absolute bound on box exits.")
        .source("obvhs, CwBvh node.rs EPSILON = 1e-4"),
    extreme(31, "dirlen_1e15")
        .all_hit(|n| long(n, 1e15))
        .because("Hits lie at t of 1e-15.")
        .source("obvhs, CwBvh node.rs EPSILON = 1e-4"),
    extreme(32, "dirlen_1e30")
        .all_hit(|n| long(n, 1e30))
        .because("Inverses of components are near the end of the range, and the square of the length overflows.")
        .source("svenstaro/bvh: misses all"),
];

/// Inside the star, mesh and origins times `scale`.
fn scaled(count: usize, scale: f32) -> Set {
    Set::new(moved(&star(), |p| p * scale), count, 11, |sampler| Ray::new(inside(sampler) * scale, sampler.direction()))
}

/// Inside the star, with directions of this length.
fn long(count: usize, length: f32) -> Set {
    Set::new(star(), count, 11, |sampler| Ray::new(inside(sampler), sampler.direction() * length))
}
