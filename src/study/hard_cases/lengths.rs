//! Scenes and directions of extreme lengths.

use super::set::{inside, moved, star};
use super::{Content, HardCase, Rank, Set};
use crate::geometry::Ray;

const OVERFLOW: &str = "Embree, FLT_LARGE; measured: every peer of f32 misses or misplaces all";

pub(super) const CASES: &[HardCase] = &[
    HardCase {
        number: 18,
        name: "scale_1e-40",
        rank: Rank::Extreme,
        content: Content::hit(|n| scaled(n, 1e-40)),
        reason: "Coordinates are denormal: every product of two of them is zero.",
        source: "measured: every f32 system misses all",
    },
    HardCase {
        number: 19,
        name: "scale_1e-30",
        rank: Rank::Extreme,
        content: Content::hit(|n| scaled(n, 1e-30)),
        reason: "Products of two lengths underflow to zero.",
        source: "measured: every f32 system misses all",
    },
    HardCase {
        number: 20,
        name: "scale_1e-20",
        rank: Rank::Extreme,
        content: Content::hit(|n| scaled(n, 1e-20)),
        reason: "Products of two lengths are denormal: their digits are gone.",
        source: "measured: every f32 system misses all",
    },
    HardCase {
        number: 21,
        name: "scale_1e-10",
        rank: Rank::Moderate,
        content: Content::hit(|n| scaled(n, 1e-10)),
        reason: "Absolute epsilons on determinants and distances swallow the whole scene.",
        source: "tinybvh pull request 283; obvhs, CwBvh node.rs EPSILON",
    },
    HardCase {
        number: 22,
        name: "scale_1e-5",
        rank: Rank::Moderate,
        content: Content::hit(|n| scaled(n, 1e-5)),
        reason: "The same at a scale that models in metres have.",
        source: "tinybvh pull request 283; obvhs, CwBvh node.rs EPSILON",
    },
    HardCase {
        number: 23,
        name: "scale_1e5",
        rank: Rank::Moderate,
        content: Content::hit(|n| scaled(n, 1e5)),
        reason: "Absolute epsilons that are too small here are no epsilons.",
        source: "Wächter, Binder 2019",
    },
    HardCase {
        number: 23,
        name: "scale_1e10",
        rank: Rank::Moderate,
        content: Content::hit(|n| scaled(n, 1e10)),
        reason: "Products of three lengths come near the end of the range.",
        source: "Embree, FLT_LARGE",
    },
    HardCase {
        number: 24,
        name: "scale_1e15",
        rank: Rank::Extreme,
        content: Content::hit(|n| scaled(n, 1e15)),
        reason: "Products of three lengths overflow.",
        source: OVERFLOW,
    },
    HardCase {
        number: 25,
        name: "scale_1e18",
        rank: Rank::Extreme,
        content: Content::hit(|n| scaled(n, 1e18)),
        reason: "Areas come near the end of the range, products of three lengths overflow.",
        source: OVERFLOW,
    },
    HardCase {
        number: 26,
        name: "dirlen_1e-30",
        rank: Rank::Extreme,
        content: Content::hit(|n| long(n, 1e-30)),
        reason: "t is measured in lengths of the direction, which need not be 1: clamps of small components lose the ray.",
        source: "obvhs, safe_inverse; Embree, zero_fix",
    },
    HardCase {
        number: 27,
        name: "dirlen_1e-20",
        rank: Rank::Extreme,
        content: Content::hit(|n| long(n, 1e-20)),
        reason: "As above, where squares of the direction underflow.",
        source: "obvhs, safe_inverse; Embree, zero_fix",
    },
    HardCase {
        number: 28,
        name: "dirlen_1e-10",
        rank: Rank::Moderate,
        content: Content::hit(|n| long(n, 1e-10)),
        reason: "As above, below the machine epsilon, which some take for zero.",
        source: "obvhs, safe_inverse: 1.19e-7",
    },
    HardCase {
        number: 29,
        name: "dirlen_1e-6",
        rank: Rank::Moderate,
        content: Content::hit(|n| long(n, 1e-6)),
        reason: "As above: only small components fall below the machine epsilon, so only some rays bend.",
        source: "obvhs, safe_inverse: 1.19e-7",
    },
    HardCase {
        number: 30,
        name: "dirlen_1e6",
        rank: Rank::Moderate,
        content: Content::hit(|n| long(n, 1e6)),
        reason: "Hits lie at t of 1e-6: below an absolute bound on box exits.",
        source: "obvhs, CwBvh node.rs EPSILON = 1e-4",
    },
    HardCase {
        number: 31,
        name: "dirlen_1e15",
        rank: Rank::Extreme,
        content: Content::hit(|n| long(n, 1e15)),
        reason: "Hits lie at t of 1e-15.",
        source: "obvhs, CwBvh node.rs EPSILON = 1e-4",
    },
    HardCase {
        number: 32,
        name: "dirlen_1e30",
        rank: Rank::Extreme,
        content: Content::hit(|n| long(n, 1e30)),
        reason: "Inverses of components are near the end of the range, and the square of the length overflows.",
        source: "svenstaro/bvh: misses all",
    },
];

/// Inside the star, mesh and origins times `scale`.
fn scaled(count: usize, scale: f32) -> Set {
    Set::new(moved(&star(), |p| p * scale), count, 11, |sampler| Ray::new(inside(sampler) * scale, sampler.direction()))
}

/// Inside the star, with directions of this length.
fn long(count: usize, length: f32) -> Set {
    Set::new(star(), count, 11, |sampler| Ray::new(inside(sampler), sampler.direction() * length))
}
