//! A slowdown for tests of what looks for slowdowns.

use std::hint::black_box;

use super::{KdTree, Plane};
use crate::geometry::Ray;
use crate::structures::walk::single;
use crate::triangle::TriangleTest;

/// Of 256 rays so many are asked twice: 11 %. The second time finds its nodes in the nearest cache.
const TWICE: u32 = 28;

/// With the feature `planted-slowdown`, which is for tests alone: makes trees of exact SAH planes, as `sah-kd` is by default, about a
/// tenth slower, and no other structure. Without it, nothing.
#[inline(always)]
pub(super) fn slow_down<const ANY: bool, T: TriangleTest>(tree: &KdTree<T>, ray: &Ray) {
    if cfg!(feature = "planted-slowdown") && tree.config.plane == Plane::SahSweep {
        // Every kind of rays is hit alike.
        let hash = (ray.origin.x.to_bits() ^ ray.direction.y.to_bits().rotate_left(9) ^ ray.direction.z.to_bits())
            .wrapping_mul(0x9e37_79b1);
        if (hash ^ hash >> 15).wrapping_mul(0x85eb_ca6b) >> 24 < TWICE {
            black_box(single::<ANY, _, ()>(tree, black_box(ray), &mut ()));
        }
    }
}
