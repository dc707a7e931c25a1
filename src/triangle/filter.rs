//! The first stage of the tests that are exact: rejects nearly all triangles of a block in `f32`, and never one that is hit.

use glam::Vec3;

use super::Corners;
use crate::geometry::Ray;
use crate::simd::{LaneVec3, Lanes};

/// A ray as the first stage sees it.
#[derive(Clone, Copy, Debug)]
pub(super) struct FilterRay {
    pub origin: Vec3,
    /// The direction, a power of two times longer: its largest component is in [1, 2), or below 1 for denormal directions.
    scaled: Vec3,
    /// The direction is so many times as long as the scaled one.
    unscaled: f32,
    /// [`TINY`], or infinity if an overflow cannot be ruled out: then nothing is rejected.
    tiny: f32,
}

/// `N` triangles with what bounds the rounding.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct FilterBlock<const N: usize> {
    corners: Corners<N>,
    /// The largest component of the two edges, which bounds the rounding; infinite if an overflow cannot be ruled out.
    extents: [f32; N],
    /// The lanes in use.
    lanes: u32,
}

/// Twice the 40 units of 2^-24 of the argument at [`survivors`], times 2 for the direction.
const SLACK: f32 = 2.0 * 40.0 * 2.0 / (1 << 24) as f32;
/// More than all underflows together: each loses at most 2^-150, and those of u, v and det add up to less than
/// (4 |s| + 12 E + 42) 2^-150, where TINY (1 + |s| + 2 E) is added. Far more, but the least number that is not denormal: for each sum with
/// one that is, some processors take a hundred cycles.
const TINY: f32 = f32::MIN_POSITIVE;
const _: () = assert!(TINY.is_normal());
/// Coordinates up to here cannot overflow: with them E is at most 2^41, |s| below 2^43, and no intermediate exceeds 2 E E |s|.
const LARGE: f32 = (1_u64 << 40) as f32;

impl FilterRay {
    #[inline(always)]
    pub fn new(ray: &Ray) -> Self {
        // Multiply by two to the negative exponent of the largest component: exact, but for components that become denormal.
        let exponent = ray.direction.abs().max_element().to_bits() >> 23;
        let scale = match exponent {
            254 => f32::MIN_POSITIVE / 2.0,
            _ => f32::from_bits((254 - exponent.max(1)) << 23),
        };
        let tiny = if ray.origin.abs().max_element() <= LARGE { TINY } else { f32::INFINITY };
        let unscaled = f32::from_bits(exponent.max(1) << 23);
        Self { origin: ray.origin, scaled: ray.direction * scale, unscaled, tiny }
    }
}

impl<const N: usize> FilterBlock<N> {
    /// # Panics
    /// If there are more than `N` triangles.
    pub fn new(triangles: &[[Vec3; 3]]) -> Self {
        let corners = Corners::new(triangles);
        let mut extents = [0.0; N];
        for (extent, &[a, b, c]) in extents.iter_mut().zip(triangles) {
            let reach = a.abs().max(b.abs()).max(c.abs()).max_element();
            let edge = (b - a).abs().max((c - a).abs()).max_element();
            *extent = if reach <= LARGE { edge } else { f32::INFINITY };
        }
        Self { corners, extents, lanes: ((1_u64 << triangles.len()) - 1) as u32 }
    }

    #[inline(always)]
    pub fn lane(&self, lane: usize) -> [Vec3; 3] {
        self.corners.lane(lane)
    }
}

/// The lanes whose triangle the ray may meet at a `t` up to `to`, all of those that it meets there among them; and a number that is positive
/// where its line certainly meets it.
///
/// **Why none is lost.** Let s = o - a, e and f the edges from a, det = e . (d x f), u = s . (d x f), v = d . (s x e), exact for
/// the `f32` corners and ray; the line meets the closed triangle if u, v and det - u - v, taken with the sign of det, are not
/// negative. Let E bound the components of e and f, D = 2 those of d, |s| be the sum of the components of s, w = 2^-24, and
/// bars mean computed. A difference of inputs is off by w of itself, a product and a sum by w of themselves. The components of d x f
/// are bounded by 2 D E and off by 3.1 w 2 D E; those of s x e by 2 E |s|, in sum, and off by 4.1 w of that. Hence
/// u is off by 7.1 w 2 D E |s|, v by 7.1 w 2 D E |s|, and det by 7.1 w 6 D E E. The sum of all three and of the rounding of u + v
/// is within k = 40 w D E (|s| + 2 E), in which more than 6 w D E |s| are left for the rounding of k itself.
///
/// Where the computed sign of det is right, a hit has u and v not below -k, and u + v not beyond |det| + k. Where it is wrong,
/// the exact |det| is at most k; then so are |u|, |v| and |u + v| of a hit, and the computed ones are at most 2 k. So rejecting what is
/// beyond 2 k rejects no hit, and what is inside by more than 2 k is one. Underflow adds less than [`TINY`] (1 + |s| + 2 E); where an intermediate might overflow the bound is
/// infinite, and comparisons that involve infinity or NaN decide nothing.
///
/// A hit at t = h / det, with h = f . (s x e), has |h| <= T |det|, where T is not below `to` for the scaled direction, nor below the least number whose rounding is relative. The computed h is off by
/// less than E / 9 of the slack, det by less than 86 w E E, where the slack is at least 320 w E E; T |det| is at most 12 E E T and rounded by w of
/// itself. So no hit has the computed h beyond that of T |det| by the slack times E + T, of which two thirds are left: that is at
/// least 16 w of T |det|, more than the test in `f64` may round its t by. The sign of det does not matter to this.
#[inline(always)]
pub(super) fn survivors<const N: usize, L: Lanes<N>>(ray: &FilterRay, block: &FilterBlock<N>, to: f32) -> (u32, L) {
    let direction = LaneVec3::splat(ray.scaled);
    let [a, b, c] = block.corners.load::<L>();
    let to_origin = LaneVec3::splat(ray.origin) - a;
    let (edge1, edge2) = (b - a, c - a);

    // Möller-Trumbore without the division. Fusing leaves out roundings, which the bound need not know.
    let p = direction.cross_loosely(edge2);
    let q = to_origin.cross_loosely(edge1);
    let det = edge1.dot_loosely(p);
    let u = to_origin.dot_loosely(p).flip_sign(det);
    let v = direction.dot_loosely(q).flip_sign(det);
    let abs_det = det.flip_sign(det);

    let extent = L::load(&block.extents);
    let size = to_origin.abs_sum().add(extent.add(extent));
    let tiny = L::splat(ray.tiny);
    let slack = size.mul_add_loosely(extent.mul_add_loosely(L::splat(SLACK), tiny), tiny);
    let below = L::zero().sub(slack);
    let outside = u.lt(below) | v.lt(below) | abs_det.add(slack).lt(u.add(v));
    let lanes = block.lanes & !outside;
    if lanes == 0 {
        return (0, slack);
    }

    // Few blocks come here. Reject what lies behind the origin: h, which has the sign of det in front of it, is off by
    // 8.1 w 2 E E |s|, of which the slack has ten times E, and by its own underflow, which needs a bound of its own: in small scenes
    // it is the last to be left of all three. Reject what lies beyond `to`.
    let height = edge2.dot_loosely(q).flip_sign(det);
    let bound = slack.mul_add_loosely(extent, tiny);
    let behind = height.add(bound).lt(L::zero()) & slack.lt(abs_det);
    let last = L::splat((to.max(f32::MIN_POSITIVE) * ray.unscaled).max(f32::MIN_POSITIVE));
    let beyond = slack.mul_add_loosely(last, bound).lt(height.sub(last.mul(abs_det)));
    // A NaN in u or v makes the third one, which wins.
    let inside = u.min(v).min(abs_det.sub(u.add(v))).sub(slack);
    (lanes & !(behind | beyond), inside)
}
