use glam::Vec3A;

use super::node::{Node, WIDTH};
use crate::geometry::Ray;
use crate::simd::{Lanes, each, indexed};
use crate::traversal::line::inverses;

/// A ray, prepared for box tests.
///
/// **No box is lost.** Errors are relative, in units of 2^-24. Let t* be an exact parameter at which the ray is in a
/// closed box. It is at least `t_min` and at most one unit beyond T, the `t` at which the search ends (see
/// [`Line`](crate::traversal::line::Line)). On each axis the ray crosses the near plane at n <= t* and the far plane at
/// f >= t*. The computed near crossing is fl(N), where N = fl(p - o) * i, p is the plane and i = fl(1 / d). The
/// computed far crossing is fl(F), where F = fl(p - o) * g, and g is i enlarged by 16 units. Two roundings put N less
/// than 2.1 units from n. Three roundings put F less than 3.1 units from the point 16 units beyond f. So `t_min` <= F
/// and, if n is not negative, N <= F for the planes of any two axes. Rounding is monotonic, so fl(N) <= fl(F), even if
/// they underflow. If n is negative, `t_min` replaces fl(N). [`after`](crate::traversal::line::after) moves `end` more
/// than 6.9 units beyond T, so fl(N) does not exceed `end`. If fl(N) overflows, `end` and fl(F) are infinite. Infinite
/// crossings (`d` = 0) order correctly. Undefined crossings are NaN (see [`inverses`]), and a NaN leaves the interval
/// unchanged. No multiplication is fused with an addition, so all levels visit the same boxes for the same `end`.
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

/// The rows of the near and the far planes in a node, by axis, for rays of an octant. A node has six rows of planes.
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
