//! The first stage of the exact test: rejects nearly all triangles of a block in `f32`, and never one that is hit; and sees most hits.

use glam::Vec3;

use super::Corners;
use super::corners::Place;
use crate::geometry::Ray;
use crate::simd::{LaneVec3, Lanes};

/// A ray as the first stage sees it.
#[derive(Clone, Copy, Debug)]
pub(super) struct FilterRay {
    origin: Vec3,
    /// The direction, a power of two times longer: its largest component is in [1, 2), or below 1 for denormal directions.
    scaled: Vec3,
    /// The scaled direction is so many times as long as the direction, which is so many times as long as the scaled one.
    scale: f32,
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

/// What the first stage has computed of `N` triangles, in the notation of [`survivors`].
#[derive(Clone, Copy, Debug)]
pub struct Survivors<L> {
    /// With the sign of det.
    height: L,
    u: L,
    v: L,
    abs_det: L,
    slack: L,
    extent: L,
    distance: L,
    tiny: L,
    scale: f32,
}

/// What the first stage knows of the candidates among `N` triangles.
#[derive(Clone, Copy, Debug)]
pub struct Sights<const N: usize> {
    /// The lanes whose triangle the line certainly meets, at an exact `t` in [`low`, `high`], as bits; of the others nothing is known.
    pub sure: u32,
    pub low: [f32; N],
    pub high: [f32; N],
}

/// 2^-24, by which a difference, a product and a sum are off, relatively.
const UNIT: f32 = f32::EPSILON / 2.0;
/// Twice the 40 units of 2^-24 of the argument at [`survivors`], times 2 for the direction.
const SLACK: f32 = 2.0 * 40.0 * 2.0 * UNIT;
/// The error of the height, in E E |s|, and of det, in E E: 17 and 98 units, of which is said where below.
const HEIGHT: f32 = 20.0 * UNIT;
const DETERMINANT: f32 = 112.0 * UNIT;
// What culling relies on.
const _: () = assert!(2.0 * SLACK > DETERMINANT && HEIGHT / SLACK == 0.125);
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
        Self { origin: ray.origin, scaled: ray.direction * scale, scale, unscaled, tiny }
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
    pub(super) fn corners(&self) -> &Corners<N> {
        &self.corners
    }

    #[inline(always)]
    pub(super) fn place(&self, lane: usize) -> Place<'_> {
        self.corners.place(lane)
    }
}

impl<L> Survivors<L> {
    /// What is certain of them, and where they are met.
    #[inline(always)]
    pub fn sights<const N: usize>(&self) -> Sights<N>
    where
        L: Lanes<N>,
    {
        let &Self { height, abs_det, u, v, slack, extent, distance, tiny, scale } = self;
        let height_error = extent.mul_add_loosely(extent.mul(distance).mul_add_loosely(L::splat(HEIGHT), tiny), tiny);
        let det_error = extent.mul_add_loosely(extent.mul_add_loosely(L::splat(DETERMINANT), tiny), tiny);
        // A NaN in u or v makes the third one, which wins.
        let inside = slack.lt(u.min(v).min(abs_det.sub(u.add(v))));
        let certain = det_error.mul(L::splat(16.0)).lt(abs_det);
        let inverse = L::splat(1.0).div(abs_det);
        let t = height.mul(inverse);
        let abs_t = t.flip_sign(t);
        let error = abs_t.mul_add_loosely(det_error, height_error).mul(inverse.mul(L::splat(9.0 / 8.0)));
        let error = abs_t.mul_add_loosely(L::splat(8.0 * UNIT), error);
        let (scale, tiny) = (L::splat(scale), L::splat(TINY));
        Sights {
            sure: inside & certain,
            low: t.sub(error).mul(scale).sub(tiny).store(),
            high: t.add(error).mul(scale).add(tiny).store(),
        }
    }
}

/// The lanes whose triangle the ray may meet at a `t` up to `to`, all of those that it meets there among them; and what is seen of them.
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
/// beyond 2 k rejects no hit, and what is inside by more than 2 k is one. Underflow adds less than [`TINY`] (1 + |s| + 2 E); where an
/// intermediate might overflow the bound is infinite, and comparisons that involve infinity or NaN decide nothing.
///
/// **Where they are met.** A hit is at t = h / |det|, with h = f . (s x e) taken with the sign of det. The computed h is off by less than
/// 8.1 w 2 E E |s|, det by less than 86 w E E; both underflow by less than [`TINY`] (1 + E). With bounds dh and dd that are larger by more than
/// they round: where |det| is beyond dd its sign is certain, and a hit with h below -dh lies behind the origin. One at a t of at most T, where T
/// is not below `to` for the scaled direction, has h - T |det| at most dh + T dd; the computed T |det|, at most 12 E E T, is off by 12 w E E T,
/// of which dd has more to spare. Here the slack 2 k (of 320 w E E or more) stands for dd, and E times an eighth of it for dh. Where |det| is beyond 16 dd, |h/d - h'/d'| <= (dh + |h'/d'| dd) / |d'| is at most 16/15 of that with
/// the computed h/d in place of the exact one, which 9/8 covers with what rounds in it; the quotient and the ends of the interval round by
/// less than 8 w of t, and [`TINY`] covers what underflows when t is that of the direction again.
#[inline(always)]
pub(super) fn survivors<const N: usize, L: Lanes<N>>(
    ray: &FilterRay,
    block: &FilterBlock<N>,
    to: f32,
) -> (u32, Survivors<L>) {
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
    let distance = to_origin.abs_sum();
    let tiny = L::splat(ray.tiny);
    let slack = distance.add(extent.add(extent)).mul_add_loosely(extent.mul_add_loosely(L::splat(SLACK), tiny), tiny);
    let below = L::zero().sub(slack);
    let outside = u.lt(below) | v.lt(below) | abs_det.add(slack).lt(u.add(v));

    // In any case, also where no lane is left: whether one is cannot be predicted, and one guess a block is enough.
    let height = edge2.dot_loosely(q).flip_sign(det);
    let height_error = extent.mul(L::splat(HEIGHT / SLACK)).mul_add_loosely(slack, tiny);
    let behind = height.add(height_error).lt(L::zero()) & slack.lt(abs_det);
    let last = L::splat((to.max(f32::MIN_POSITIVE) * ray.unscaled).max(f32::MIN_POSITIVE));
    let beyond = slack.mul_add_loosely(last, height_error).lt(height.sub(last.mul(abs_det)));
    let survivors = Survivors { height, u, v, abs_det, slack, extent, distance, tiny, scale: ray.scale };
    (block.lanes & !(outside | behind | beyond), survivors)
}
