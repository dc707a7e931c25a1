//! The first stage of the exact test, in `f32`. It rejects most triangles that the ray misses, and none that it hits.

use glam::{Vec3, Vec3Swizzles as _};

use super::{Corners, EightRays};
use crate::geometry::Ray;
use crate::simd::{EightLanes, LaneVec3, Lanes};

/// A ray, prepared for the first stage.
#[derive(Clone, Copy, Debug)]
pub(super) struct FilterRay {
    origin: Vec3,
    /// The direction times [`Scaling::scale`].
    scaled: Vec3,
    scaling: Scaling,
}

/// The power of two that scales the largest direction component to [1, 2), or to less if the component is denormal.
#[derive(Clone, Copy, Debug)]
struct Scaling {
    /// The power of two. `unscaled` is its inverse.
    scale: f32,
    unscaled: f32,
    /// [`TINY`], or infinity if an overflow is possible. Infinity rejects no triangle.
    tiny: f32,
}

/// `N` triangles, and the sizes that bound the rounding errors.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct FilterBlock<const N: usize> {
    pub(super) corners: Corners<N>,
    /// The largest magnitude of an edge component. Infinite if an overflow is possible, negative in unused lanes.
    extents: [f32; N],
    /// [`HEIGHT`] times the bound N of [`filter_block`] on the components of the normal, rounded up.
    areas: [f32; N],
}

/// The results of the first stage for `N` triangles, in the notation of [`filter_block`].
#[derive(Clone, Copy, Debug)]
pub struct Candidates<L> {
    /// The computed h.
    height: L,
    abs_det: L,
    /// The minimum of u and v, both times the sign of det, and |det| - u - v. NaN if one of these is NaN.
    least: L,
    slack: L,
    height_error: L,
    area: L,
    underflow: L,
    scale: f32,
}

/// The candidates among `N` triangles that the line certainly meets, and bounds of their `t`.
#[derive(Clone, Copy, Debug)]
pub struct CandidateBounds<const N: usize> {
    /// The lanes whose triangle the line certainly meets, at an exact `t` in [`low`, `high`], as bits.
    pub sure: u32,
    pub low: [f32; N],
    pub high: [f32; N],
}

/// 2^-24, the relative error of a difference, a product and a sum.
const UNIT: f32 = f32::EPSILON / 2.0;
/// `SLACK` E (|s| + 2 E) is 2 k, with the k = 40 w D E (|s| + 2 E) and D = 2 of [`filter_block`].
const SLACK: f32 = 2.0 * 40.0 * 2.0 * UNIT;
/// The error of h is at most `HEIGHT` N |s|, the error of det at most `DETERMINANT` `HEIGHT` N: see [`filter_block`].
const HEIGHT: f32 = 10.0 * UNIT;
const DETERMINANT: f32 = 6.0;
/// Covers all underflows. Each underflow loses at most 2^-150. The underflows of u, v and det add up to less than
/// (4 |s| + 12 E + 42) 2^-150, and the slack adds TINY (1 + |s| + 2 E). Not denormal: sums of denormals are slow.
const TINY: f32 = f32::MIN_POSITIVE;
const _: () = assert!(TINY.is_normal());
/// Coordinates up to `LARGE` cannot overflow: E is at most 2^41, |s| below 2^43, intermediates at most 2 E E |s|.
const LARGE: f32 = (1_u64 << 40) as f32;

impl Scaling {
    /// `longest` and `farthest` bound the magnitudes of the components of directions and of origins.
    #[inline(always)]
    fn new(longest: f32, farthest: f32) -> Self {
        // Scale by 2^-e, where e is the exponent of the largest component: exact, unless the result is denormal.
        let exponent = longest.to_bits() >> 23;
        let scale = match exponent {
            254 => f32::MIN_POSITIVE / 2.0,
            _ => f32::from_bits((254 - exponent.max(1)) << 23),
        };
        let tiny = if farthest <= LARGE { TINY } else { f32::INFINITY };
        Self { scale, unscaled: f32::from_bits(exponent.max(1) << 23), tiny }
    }
}

impl FilterRay {
    #[inline(always)]
    pub fn new(ray: &Ray) -> Self {
        let scaling = Scaling::new(ray.direction.abs().max_element(), ray.origin.abs().max_element());
        Self { origin: ray.origin, scaled: ray.direction * scaling.scale, scaling }
    }
}

impl<const N: usize> FilterBlock<N> {
    pub fn new(triangles: &[[Vec3; 3]]) -> Self {
        let corners = Corners::new(triangles);
        let (mut extents, mut areas) = ([-1.0; N], [0.0; N]);
        for (lane, &[a, b, c]) in triangles.iter().enumerate() {
            let reach = a.abs().max(b.abs()).max(c.abs()).max_element();
            let edge = (b - a).abs().max((c - a).abs()).max_element();
            extents[lane] = if reach <= LARGE { edge } else { f32::INFINITY };
            let [a, b, c] = [a, b, c].map(|corner| corner.as_dvec3());
            let (e, f) = ((b - a).abs(), (c - a).abs());
            let normal = e.yzx() * f.zxy() + e.zxy() * f.yzx();
            areas[lane] = (normal.max_element() as f32 * HEIGHT).next_up().max(f32::MIN_POSITIVE);
        }
        Self { corners, extents, areas }
    }
}

impl<L> Candidates<L> {
    /// The lanes whose triangle the line certainly meets, and the bounds of their `t`.
    #[inline(always)]
    pub fn bounds<const N: usize>(&self) -> CandidateBounds<N>
    where
        L: Lanes<N>,
    {
        let ([inside, certain], [low, high]) = self.look();
        CandidateBounds {
            sure: inside[0].lt(inside[1]) & certain[0].lt(certain[1]),
            low: low.store(),
            high: high.store(),
        }
    }

    /// Two pairs of numbers and two bounds per lane. If the first number is below the second in both pairs, the line
    /// certainly meets the triangle, at an exact `t` between the bounds.
    #[inline(always)]
    pub(super) fn look<const N: usize>(&self) -> ([[L; 2]; 2], [L; 2])
    where
        L: Lanes<N>,
    {
        let &Self { height, height_error, abs_det, least, slack, area, underflow, scale } = self;
        let det_error = area.mul_add_loosely(L::splat(DETERMINANT), underflow);
        let inverse = L::splat(1.0).div(abs_det);
        let t = height.mul(inverse);
        let abs_t = t.flip_sign(t);
        let error = abs_t.mul_add_loosely(det_error, height_error).mul(inverse.mul(L::splat(9.0 / 8.0)));
        let error = abs_t.mul_add_loosely(L::splat(8.0 * UNIT), error);
        let (scale, tiny) = (L::splat(scale), L::splat(TINY));
        let bounds = [t.sub(error).mul(scale).sub(tiny), t.add(error).mul(scale).add(tiny)];
        ([[slack, least], [det_error.mul(L::splat(16.0)), abs_det]], bounds)
    }
}

/// The lanes whose triangle the ray may meet at a `t` up to `to`, as bits, and the results. No hit is left out.
///
/// **Why no hit is lost.** Let o and d be origin and direction, a the first corner, s = o - a, e and f the edges from
/// a, det = e . (d x f), u = s . (d x f), v = d . (s x e), all exact for the `f32` input. The line meets the closed
/// triangle if u, v and det - u - v, each times the sign of det, are not negative. Let E bound the components of e and
/// f, D = 2 the components of d, |s| be the sum of the magnitudes of the components of s, and w = 2^-24 the relative
/// error of a difference of inputs, a product and a sum. The components of d x f are at most 2 D E, with an error of
/// 3.1 w 2 D E; the sum of the components of s x e is at most 2 E |s|, with an error of 4.1 w 2 E |s|. Hence the errors
/// of u and v are at most 7.1 w 2 D E |s|, and the error of det is at most 7.1 w 6 D E E. These three errors, the
/// rounding of u + v, and the rounding of det - (u + v) add up to at most k = 40 w D E (|s| + 2 E), with more than 6 w
/// D E |s| to spare for the rounding of k itself. The sign of the last sum, which adds the slack, is exact.
///
/// If the computed sign of det is right, a hit has u and v of at least -k, and u + v of at most |det| + k. If it is
/// wrong, the exact |det| is at most k. Then |u|, |v| and |u + v| of a hit are at most k, and their computed values at
/// most 2 k. So rejecting values that are outside by more than 2 k rejects no hit, and values inside by more than 2 k
/// prove a hit. Underflow adds less than [`TINY`] (1 + |s| + 2 E). If an intermediate may overflow, the slack is
/// infinite. Comparisons with infinity or NaN then neither reject a triangle nor prove a hit.
///
/// **The bounds of `t`.** A hit is at t = h / |det|, where h is f . (s x e) times the sign of det. Let N bound |e_i
/// f_k| + |e_k f_i| for each pair of axes, and so the components of e x f. Each term s_i e_k f_j of the computed h has
/// a relative error of 8.1 w, each term d_i e_k f_j of det has 7.1 w. So the error of h is less than 8.1 w N |s|, and
/// the error of det is less than 43 w N. Underflow adds less than [`TINY`] (1 + E) to each. The bounds dh = 10 w N |s|
/// and dd = 60 w N exceed these errors and their own rounding. If |det| exceeds dd, its sign is certain, and a computed
/// h below -dh means that t is negative. Let T be at least `to`, in lengths of the scaled direction. A hit at a t up to
/// T has h - T |det| <= dh + T dd. Because T |det| is at most 6 N T, this difference has an error of 7 w N T plus w of
/// itself, which dd covers too. The code uses the slack 2 k, at least 160 w N, instead of dd. Let det' and h' be the
/// computed values. If |det'| exceeds 16 dd, |h/det - h'/det'| <= (dh + |h'/det'| dd) / |det|. This is at most 16/15
/// times the same quotient with divisor |det'|; the code uses 9/8 to cover the rounding, too. The quotient and the ends
/// of the interval round by less than 8 w t, and [`TINY`] covers the underflow when t is scaled back. No relevant value
/// underflows earlier: a value inside by more than 2 k has |s| > 2^-18 E, and a det beyond 16 TINY requires E > 2^-63,
/// so the error exceeds 2^-104.
#[inline(always)]
pub(super) fn filter_block<const N: usize, L: Lanes<N>>(
    ray: &FilterRay,
    block: &FilterBlock<N>,
    to: f32,
) -> (u32, Candidates<L>) {
    let last = L::splat((to.max(f32::MIN_POSITIVE) * ray.scaling.unscaled).max(f32::MIN_POSITIVE));
    let (origin, direction) = (LaneVec3::splat(ray.origin), LaneVec3::splat(ray.scaled));
    let (extents, areas) = (L::load(&block.extents), L::load(&block.areas));
    let (signs, candidates) =
        filter_lanes(origin, direction, ray.scaling, block.corners.load::<L>(), [extents, areas], last);
    (!signs.lt(L::zero()) & ((1_u64 << N) - 1) as u32, candidates)
}

/// Like [`filter_block`], for eight rays and one triangle. Returns the rays that miss the triangle, and the results.
///
/// All directions are scaled like the longest one. The argument at [`filter_block`] only requires that no component is
/// beyond 2, and that a component that becomes denormal has an error of at most 2^-150, so it holds for all rays.
#[inline(always)]
pub(super) fn filter_eight<const N: usize, L: EightLanes>(
    rays: &EightRays<L>,
    block: &FilterBlock<N>,
    lane: usize,
    to: L,
) -> (L::Mask, Candidates<L>) {
    let scaling = Scaling::new(rays.longest, rays.farthest);
    let least = L::splat(f32::MIN_POSITIVE);
    let last = to.max(least).mul(L::splat(scaling.unscaled)).max(least);
    let scale = L::splat(scaling.scale);
    let LaneVec3 { x, y, z, .. } = rays.direction;
    let direction = LaneVec3::new(x.mul(scale), y.mul(scale), z.mul(scale));
    let sizes = [L::splat(block.extents[lane]), L::splat(block.areas[lane])];
    let (signs, candidates) = filter_lanes(rays.origin, direction, scaling, block.corners.splat(lane), sizes, last);
    (signs.cmp_lt(L::zero()), candidates)
}

/// The filter for one line and one triangle per lane, with the corners, extents and areas of the triangles. If the
/// first result is negative, the line does not meet the triangle at a `t` in [0, `last`] of the scaled direction.
#[inline(always)]
fn filter_lanes<const N: usize, L: Lanes<N>>(
    origin: LaneVec3<N, L>,
    direction: LaneVec3<N, L>,
    scaling: Scaling,
    [a, b, c]: [LaneVec3<N, L>; 3],
    [extent, area]: [L; 2],
    last: L,
) -> (L, Candidates<L>) {
    let to_origin = origin - a;
    let (edge1, edge2) = (b - a, c - a);

    // Möller-Trumbore without the division. Fused operations round less often, which the bounds allow.
    let p = direction.cross_loosely(edge2);
    let q = to_origin.cross_loosely(edge1);
    let det = edge1.dot_loosely(p);
    let u = to_origin.dot_loosely(p).flip_sign(det);
    let v = direction.dot_loosely(q).flip_sign(det);
    let abs_det = det.flip_sign(det);

    let distance = to_origin.abs_sum();
    let tiny = L::splat(scaling.tiny);
    let slack = distance.add(extent.add(extent)).mul_add_loosely(extent.mul_add_loosely(L::splat(SLACK), tiny), tiny);
    // If u or v is NaN, the third value is NaN, too, and `min` returns it as its second operand.
    let least = u.min(v).min(abs_det.sub(u.add(v)));
    let outside = least.add(slack);

    // Compute the height even if no lane remains: a branch would be unpredictable, and the caller branches anyway.
    let height = edge2.dot_loosely(q).flip_sign(det);
    let underflow = extent.mul_add_loosely(tiny, tiny);
    let height_error = area.mul_add_loosely(distance, underflow);
    let behind = slack.sub(abs_det).max(height.add(height_error));
    let beyond = slack.mul_add_loosely(last, height_error).add(last.mul_sub_loosely(abs_det, height));

    // Each value is negative if it rejects the lane, and NaN if it cannot decide. The minimum is negative only if one
    // of the values is. In unused lanes, the extent is negative.
    let signs = beyond.min(behind).min(outside).min(extent);
    let scale = scaling.scale;
    (signs, Candidates { height, height_error, abs_det, least, slack, area, underflow, scale })
}
