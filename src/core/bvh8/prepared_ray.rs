//! A ray, prepared for the boxes of wide nodes.

use glam::Vec3A;

use super::node::{Node, WIDTH};
use crate::geometry::Ray;
use crate::simd::{Lanes, each, indexed};
use crate::traversal::line::inverses;

/// A ray, prepared for the boxes of nodes.
///
/// **No box is lost.** Let the ray be in a closed box at the exact parameter t* in [`t_min`, `end`]. On each axis it
/// crosses the near plane at n <= t* and the far plane at f >= t*. The near crossing is computed as N = fl(p - o) i,
/// rounded, where i = fl(1 / d); the far one as F = fl(p - o) g, rounded, where g is i enlarged by 8 units of 2^-23.
/// Two roundings move N away from n by less than 2.1 units of 2^-24, relatively, and three move F by less than 3.1 from
/// 16 units beyond f. So N <= F for the planes of any two axes if n is not negative, and t_min <= F; because the last
/// rounding is monotonic, the rounded ones have the same order, even if the products underflow. If n is negative, t_min
/// replaces it. `end` is 8 units beyond the last parameter of interest, which n does not exceed; if N overflows, `end`
/// is infinite (see [`Line`](crate::traversal::line::Line)), and so is F. Infinite crossings (`d` = 0) order correctly,
/// and undefined ones are NaN (see [`inverses`]), which leaves the interval unchanged. Nothing is fused: all levels
/// visit the same boxes for the same `end`.
#[derive(Clone, Copy)]
pub(super) struct PreparedRay {
    origin: [f32; 3],
    inverse: [f32; 3],
    enlarged: [f32; 3],
    /// By axis, the byte offsets of the near and of the far planes.
    near: [usize; 3],
    far: [usize; 3],
    pub t_min: f32,
    /// Bit 0 is set for a negative x.
    pub octant: usize,
}

/// The factor that enlarges the crossings of far planes.
pub(super) const ENLARGED: f32 = 1.0 + 8.0 * f32::EPSILON;

/// By axis, the rows of planes, among six, that are near and that are far for rays of an octant.
#[inline(always)]
pub(super) fn rows(octant: usize) -> ([usize; 3], [usize; 3]) {
    let [x, y, z] = indexed(|axis| octant >> axis & 1);
    ([x, 2 + y, 4 + z], [1 - x, 3 - y, 5 - z])
}

impl PreparedRay {
    /// Prepares `ray` for boxes whose coordinates have at most the magnitudes `farthest`.
    #[inline(always)]
    pub fn new(ray: &Ray, farthest: Vec3A, t_min: f32) -> Self {
        let octant = ray.vectors().1.is_negative_bitmask();
        Self::of(ray.origin.to_array(), inverses(ray, farthest), t_min, octant as usize)
    }

    /// From its parts.
    #[inline(always)]
    pub fn of(origin: [f32; 3], inverse: [f32; 3], t_min: f32, octant: usize) -> Self {
        let (near, far) = rows(octant);
        let bytes = |&row: &usize| row * size_of::<[f32; WIDTH]>();
        Self {
            origin,
            inverse,
            enlarged: each(&inverse, |&i| i * ENLARGED),
            near: each(&near, bytes),
            far: each(&far, bytes),
            t_min,
            octant,
        }
    }

    /// The parameters at which the ray enters and leaves the boxes, both within the interval: it misses a box that it
    /// leaves before it enters.
    #[inline(always)]
    pub fn cross<L: Lanes<WIDTH>>(&self, node: &Node, end: f32) -> (L, L) {
        let planes = (&raw const node.planes).cast::<u8>();
        let (mut enter, mut leave) = (L::splat(self.t_min), L::splat(end));
        for axis in 0..3 {
            // SAFETY: `near` and `far` are the offsets that `of` has computed from numbers of `rows`, all below the six
            // rows of `planes`; a row of floats has the alignment of the node.
            let (near, far) = unsafe { (&*planes.add(self.near[axis]).cast(), &*planes.add(self.far[axis]).cast()) };
            enter = L::load(near).sub(L::splat(self.origin[axis])).mul(L::splat(self.inverse[axis])).max(enter);
            leave = L::load(far).sub(L::splat(self.origin[axis])).mul(L::splat(self.enlarged[axis])).min(leave);
        }
        (enter, leave)
    }
}
