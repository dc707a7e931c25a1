use glam::Vec3A;

use super::node::{Node, WIDTH};
use crate::geometry::Ray;
use crate::simd::{Lanes, each, indexed};
use crate::traversal::line::inverses;

/// A ray, prepared for the boxes of nodes.
///
/// **No box is lost.** Units are 2^-24, relative to a parameter. Let the ray be in a closed box at the exact parameter
/// t* >= `t_min`, which is at most one unit beyond the last parameter of interest (see
/// [`Line`](crate::traversal::line::Line)). On each axis the ray crosses the near plane at n <= t* and the far plane at
/// f >= t*. The computed near crossing is the rounded product N = fl(p - o) * i, where i = fl(1 / d). The computed far
/// crossing is the rounded product F = fl(p - o) * g, where g is i enlarged by 16 units. Before the products are
/// rounded, N is less than 2.1 units from n because of two roundings. F is less than 3.1 units from a point 16 units
/// beyond f because of three roundings. So N <= F for the planes of any two axes if n is not negative, and `t_min` <=
/// F. Rounding is monotonic, so the rounded products have the same order, even if they underflow. If n is negative,
/// `t_min` replaces N. Callers move `end` beyond the last parameter of interest with
/// [`after`](crate::traversal::line::after), by more than 6.9 units: the rounded N does not exceed it. If N overflows,
/// `end` is infinite, and so is F. Infinite crossings (`d` = 0) order correctly. Undefined crossings are NaN (see
/// [`inverses`]), which leaves the interval unchanged. No multiplication is fused with an addition: all instruction
/// levels visit the same boxes for the same `end`.
#[derive(Clone, Copy)]
pub(super) struct PreparedRay {
    origin: [f32; 3],
    inverse: [f32; 3],
    enlarged: [f32; 3],
    /// The byte offsets of the near planes in a node, by axis.
    near: [usize; 3],
    /// The byte offsets of the far planes.
    far: [usize; 3],
    pub t_min: f32,
    /// The octant of the direction: bits 0, 1 and 2 are set for a negative x, y and z.
    pub octant: usize,
}

/// The factor that enlarges the crossings of far planes.
pub(super) const ENLARGED: f32 = 1.0 + 8.0 * f32::EPSILON;

/// The rows of the near and of the far planes for rays of an octant, by axis. A node has six rows of planes.
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

    /// For each box, the parameter at which the ray enters it, at least `t_min`, and the parameter at which the ray
    /// leaves it, at most `end`. The ray misses a box if it leaves before it enters.
    #[inline(always)]
    pub fn cross<L: Lanes<WIDTH>>(&self, node: &Node, end: f32) -> (L, L) {
        let planes = (&raw const node.planes).cast::<u8>();
        let (mut enter, mut leave) = (L::splat(self.t_min), L::splat(end));
        for axis in 0..3 {
            // SAFETY: `of` computes the offsets `near` and `far` from the results of `rows`, which are below 6, the
            // number of rows of `planes`; each row is an aligned array of floats.
            let (near, far) = unsafe { (&*planes.add(self.near[axis]).cast(), &*planes.add(self.far[axis]).cast()) };
            enter = L::load(near).sub(L::splat(self.origin[axis])).mul(L::splat(self.inverse[axis])).max(enter);
            leave = L::load(far).sub(L::splat(self.origin[axis])).mul(L::splat(self.enlarged[axis])).min(leave);
        }
        (enter, leave)
    }
}
