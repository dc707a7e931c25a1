//! A slowdown for tests of what looks for slowdowns.

use std::hint::black_box;

use super::{KdConfig, KdTree};
use crate::geometry::Ray;
use crate::structures::walk::single;
use crate::triangle::TriangleTest;

/// Of 256 rays so many are asked twice. The second time finds its nodes in the nearest cache, so that the time grows by less.
const TWICE: u32 = 32;

/// With the feature `planted-slowdown`, which is for tests alone: makes the SAH tree with its default configuration, and no other,
/// about a tenth slower. Without it, nothing.
#[inline(always)]
pub(super) fn slow_down<const ANY: bool, T: TriangleTest>(tree: &KdTree<T>, ray: &Ray) {
    if cfg!(feature = "planted-slowdown") && tree.config == KdConfig::SAH {
        // Rays look at random for this hash, so that every kind of rays is hit alike.
        let bits = ray.origin.to_array().into_iter().chain(ray.direction.to_array()).map(f32::to_bits);
        let hash = bits.fold(0x811c_9dc5_u32, |hash, bits| (hash ^ bits).wrapping_mul(0x9e37_79b1).rotate_left(13));
        if hash.wrapping_mul(0x85eb_ca6b) >> 24 < TWICE {
            black_box(single::<ANY, _, ()>(tree, black_box(ray), &mut ()));
        }
    }
}
