use glam::Vec3A;

use super::node::{Node, WIDTH};
use crate::geometry::Ray;
use crate::simd::{Lanes, each, indexed};
use crate::traversal::line::inverses;

/// A ray, prepared for box tests.
///
/// **No box is lost.** Errors are relative, in units of 2^-24. Let a closed box contain a hit at the exact parameter
/// t*. Let T be the `t` of the nearest hit so far, or the end of the ray. The proof assumes that t* is at least `t_min`
/// and at most one unit beyond T. One unit covers the rounding of `t` in triangle tests (see
/// [`Line`](crate::traversal::line::Line)).
///
/// On each axis, the ray crosses the near plane at n <= t*. The ray crosses the far plane at f >= t*.
///
/// - For a near plane p, the entry is fl(N), where N = fl(p - o) * i and i = fl(1 / d). Two roundings put N less than
///   2.1 units from n.
/// - For a far plane p, the exit is fl(F), where F = fl(p - o) * g. The factor g is i, enlarged by 16 units and
///   rounded. Three roundings put F less than 3.1 units from the point 16 units beyond f.
/// - So F is at least f. From f >= t* >= `t_min` follows fl(F) >= `t_min`.
/// - If n is not negative, N <= F for every near plane and every far plane of the box, also on different axes. Rounding
///   is monotonic, so fl(N) <= fl(F).
/// - If n is negative, the maximum of fl(N) and `t_min` is `t_min`.
/// - Callers pass `end` = `after(T)`, which is more than 6.9 units beyond T (see
///   [`after`](crate::traversal::line::after)). t* is at most 1 unit beyond T, N less than 2.1 units beyond n, and
///   fl(N) at most 1 unit beyond N. So without underflow, fl(N) <= `end`.
/// - If fl(N) is subnormal, fl(N) <= `end`, because `after` adds the smallest normal float.
/// - If fl(N) overflows, `end` and fl(F) are infinite.
/// - Infinite crossings (d = 0) compare correctly. Undefined crossings are NaN. A NaN leaves the interval unchanged.
///
/// No multiplication is fused with an addition. So all SIMD levels visit the same boxes for the same `end`.
#[derive(Clone, Copy)]
pub(super) struct PreparedRay {
    origin: [f32; 3],
    inverse: [f32; 3],
    enlarged: [f32; 3],
    /// The byte offsets of the near planes in a node, by axis.
    near: [usize; 3],
    far: [usize; 3],
    pub t_min: f32,
    /// The octant of the direction. Bits 0, 1 and 2 are the sign bits of x, y and z.
    pub octant: usize,
}

/// Enlarges inverses by 16 units of 2^-24 (see [`PreparedRay`]).
pub(super) const ENLARGED: f32 = 1.0 + 8.0 * f32::EPSILON;

/// The rows (0 to 5) of the near planes and the rows of the far planes, by axis.
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

    /// Returns the parameters of entry and exit for each box.
    ///
    /// Entries are at least `t_min`. Exits are at most `end`. The ray misses a box if the exit is below the entry.
    #[inline(always)]
    pub fn cross<L: Lanes<WIDTH>>(&self, node: &Node, end: f32) -> (L, L) {
        let planes = (&raw const node.planes).cast::<u8>();
        let (mut enter, mut leave) = (L::splat(self.t_min), L::splat(end));
        for axis in 0..3 {
            // SAFETY: `of` computes the offsets from row numbers below 6. `planes` has 6 rows. Each row is an aligned
            // array of floats.
            let (near, far) = unsafe { (&*planes.add(self.near[axis]).cast(), &*planes.add(self.far[axis]).cast()) };
            enter = L::load(near).sub(L::splat(self.origin[axis])).mul(L::splat(self.inverse[axis])).max(enter);
            leave = L::load(far).sub(L::splat(self.origin[axis])).mul(L::splat(self.enlarged[axis])).min(leave);
        }
        (enter, leave)
    }
}
