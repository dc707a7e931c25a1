//! Scenes and directions of extreme lengths.

use super::case::cases;
use super::set::{Set, inside, moved, star};
use crate::geometry::Ray;

const EPSILON: &str = "obvhs, CwBvh node.rs EPSILON = 1e-4";
const EPSILONS: &str = "tinybvh pull request 283; obvhs, CwBvh node.rs EPSILON";
const INVERSE: &str = "obvhs, safe_inverse: 1.19e-7";
const INVERSES: &str = "obvhs, safe_inverse; Embree, zero_fix";
const MISSED: &str = "measured: every f32 system misses all";
const OVERFLOW: &str = "Embree, FLT_LARGE; measured: every peer of f32 misses or misplaces all";

cases! {
    Extreme 18 "scale_1e-40", Hit => |n| scaled(n, 1e-40),
        "Coordinates are denormal: every product of two of them is zero.", MISSED;
    Extreme 19 "scale_1e-30", Hit => |n| scaled(n, 1e-30),
        "Products of two lengths underflow to zero.", MISSED;
    Extreme 20 "scale_1e-20", Hit => |n| scaled(n, 1e-20),
        "Products of two lengths are denormal: their digits are gone.", MISSED;
    Moderate 21 "scale_1e-10", Hit => |n| scaled(n, 1e-10),
        "Absolute epsilons on determinants and distances swallow the whole scene.", EPSILONS;
    Moderate 22 "scale_1e-5", Hit => |n| scaled(n, 1e-5),
        "The same at a scale that models in metres have.", EPSILONS;
    Moderate 23 "scale_1e5", Hit => |n| scaled(n, 1e5),
        "Absolute epsilons that are too small here are no epsilons.", "Wächter, Binder 2019";
    Moderate 23 "scale_1e10", Hit => |n| scaled(n, 1e10),
        "Products of three lengths come near the end of the range.", "Embree, FLT_LARGE";
    Extreme 24 "scale_1e15", Hit => |n| scaled(n, 1e15),
        "Products of three lengths overflow.", OVERFLOW;
    Extreme 25 "scale_1e18", Hit => |n| scaled(n, 1e18),
        "Areas come near the end of the range, products of three lengths overflow.", OVERFLOW;
    Extreme 26 "dirlen_1e-30", Hit => |n| long(n, 1e-30),
        "t is measured in lengths of the direction, which need not be 1: clamps of small components lose the ray.", INVERSES;
    Extreme 27 "dirlen_1e-20", Hit => |n| long(n, 1e-20),
        "As above, where squares of the direction underflow.", INVERSES;
    Moderate 28 "dirlen_1e-10", Hit => |n| long(n, 1e-10),
        "As above, below the machine epsilon, which some take for zero.", INVERSE;
    Moderate 29 "dirlen_1e-6", Hit => |n| long(n, 1e-6),
        "As above: only small components fall below the machine epsilon, so only some rays bend.", INVERSE;
    Moderate 30 "dirlen_1e6", Hit => |n| long(n, 1e6),
        "Hits lie at t of 1e-6: below an absolute bound on box exits.", EPSILON;
    Extreme 31 "dirlen_1e15", Hit => |n| long(n, 1e15),
        "Hits lie at t of 1e-15.", EPSILON;
    Extreme 32 "dirlen_1e30", Hit => |n| long(n, 1e30),
        "Inverses of components are near the end of the range, and the square of the length overflows.",
        "svenstaro/bvh: misses all";
}

/// Inside the star, mesh and origins times `scale`.
fn scaled(count: usize, scale: f32) -> Set {
    Set::new(moved(&star(), |p| p * scale), count, 11, |sampler| Ray::new(inside(sampler) * scale, sampler.direction()))
}

/// Inside the star, with directions of this length.
fn long(count: usize, length: f32) -> Set {
    Set::new(star(), count, 11, |sampler| Ray::new(inside(sampler), sampler.direction() * length))
}
