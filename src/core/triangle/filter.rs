//! The `f32` stage of the exact test.

use glam::{Vec3, Vec3Swizzles as _};

use super::{Corners, EightRays};
use crate::geometry::Ray;
use crate::simd::{EightLanes, LaneVec3, Lanes};

#[derive(Clone, Copy, Debug)]
pub(super) struct FilterRay {
    origin: Vec3,
    scaled: Vec3,
    scaling: Scaling,
}

/// Scales the largest magnitude of a direction component to [1, 2).
///
/// If this magnitude is denormal, the scaled magnitude is less than 1.
#[derive(Clone, Copy, Debug)]
struct Scaling {
    /// A power of two. `unscaled` is the inverse.
    scale: f32,
    unscaled: f32,
    /// [`TINY`], or infinity if an overflow is possible. An infinite `tiny` prevents rejections of triangles.
    tiny: f32,
}

#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct FilterBlock<const N: usize> {
    pub(super) corners: Corners<N>,
    /// The largest magnitude of an edge component. Infinite if an overflow is possible. Negative in unused lanes.
    extents: [f32; N],
    /// The product of [`HEIGHT`] and P, rounded up. [`filter_block`] defines P.
    areas: [f32; N],
}

/// Intermediate results of the `f32` stage, in the notation of [`filter_block`].
#[derive(Clone, Copy, Debug)]
pub struct Candidates<L> {
    /// The computed h.
    height: L,
    abs_det: L,
    /// The computed m. NaN if u, v or det is NaN.
    least: L,
    slack: L,
    height_error: L,
    area: L,
    underflow: L,
    scale: f32,
}

#[derive(Clone, Copy, Debug)]
pub struct CandidateBounds<const N: usize> {
    /// Bit `i` is set if the line certainly meets the triangle in lane `i`.
    pub sure: u32,
    /// Lower bounds of the exact `t`, in the lanes of `sure`.
    pub low: [f32; N],
    /// Upper bounds of the exact `t`, in the lanes of `sure`.
    pub high: [f32; N],
}

/// The unit roundoff of `f32`, 2^-24.
const UNIT: f32 = f32::EPSILON / 2.0;
/// The bound 2 k of [`filter_block`] is `SLACK` E (|s| + 2 E).
const SLACK: f32 = 2.0 * 40.0 * 2.0 * UNIT;
/// The bound dh of [`filter_block`] is `HEIGHT` P |s|.
const HEIGHT: f32 = 10.0 * UNIT;
/// The bound dd of [`filter_block`] is `DETERMINANT` `HEIGHT` P.
const DETERMINANT: f32 = 6.0;
/// In the notation of [`filter_block`], the underflows of u, v and det add up to less than (4 |s| + 12 E + 42) 2^-150.
/// The slack contains `TINY` (1 + |s| + 2 E) to cover these underflows. A denormal constant would be slow.
const TINY: f32 = f32::MIN_POSITIVE;
const _: () = assert!(TINY.is_normal());
/// If no coordinate exceeds `LARGE` in magnitude, the computation of u, v, det and h cannot overflow.
///
/// For these coordinates, E <= 2^41 and |s| < 2^43 in the notation of [`filter_block`]. Hence the magnitudes of u, v,
/// det and h are below 2^126.
const LARGE: f32 = (1_u64 << 40) as f32;

impl Scaling {
    /// `longest` bounds the magnitudes of direction components. `farthest` bounds the magnitudes of origin components.
    #[inline(always)]
    fn new(longest: f32, farthest: f32) -> Self {
        // A product with `scale` is exact, unless the product is denormal.
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

    /// Returns two pairs of numbers and two bounds of `t` per lane.
    ///
    /// If the first number is less than the second number in both pairs, the line certainly meets the triangle. The
    /// exact `t` is then between the two bounds.
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

/// The bits of the first result mark the lanes that the ray may hit at a `t` up to `to`.
///
/// **Notation.** Let o be the origin and d the scaled direction. Let a, b and c be the corners. Let e = b - a,
/// f = c - a and s = o - a. Let det = e . (d x f), u = s . (d x f) and v = d . (s x e).
///
/// Let E bound the magnitudes of the components of e and f. Let D = 2 bound the magnitudes of the components of d. Let
/// |s| be the sum of the magnitudes of the components of s. Let w = 2^-24 bound the relative rounding error of one
/// operation.
///
/// **No hit is lost.** Let det be nonzero. Multiply u, v and det - u - v by the sign of det. The line meets the closed
/// triangle if and only if no product is negative. The errors of u and v are at most 14.2 w D E |s|. The error of det
/// is at most 42.6 w D E E. These errors and the rounding of det - (u + v) add up to at most k = 40 w D E (|s| + 2 E).
/// The factor 40 also covers the rounding of k. The sum of m and the slack, defined below, has the exact sign.
///
/// From here, u and v are multiplied by the computed sign of det. Let m be the minimum of u, v and |det| - u - v.
///
/// - If the computed sign is right, the computed u and v of a hit are at least -k. The computed |det| - u - v of a hit
///   is also at least -k.
/// - If the computed sign is wrong, the exact |det| is at most k. The exact |u|, |v| and |u + v| of a hit are then at
///   most k. Hence the computed |u|, |v| and |u + v| are at most 2 k.
///
/// Hence the computed m of a hit is at least -2 k. If the computed m exceeds 2 k, the line meets the triangle.
///
/// The slack is 2 k + [`TINY`] (1 + |s| + 2 E). The [`TINY`] term covers underflow. If an overflow is possible, the
/// slack is infinite or NaN. Comparisons with infinity or NaN neither reject a triangle nor prove a hit.
///
/// **Errors of h and det.** Let h be the product of f . (s x e) and the sign of det. A hit is at t = h / |det|. Let P
/// bound |e_i f_k| + |e_k f_i| for each pair of axes i and k. The error of h is less than 8.1 w P |s|. The error of det
/// is less than 43 w P. The larger bounds dh = 10 w P |s| and dd = 60 w P also cover the rounding of dh and dd.
/// Underflow adds less than [`TINY`] (1 + E) to each error.
///
/// **Hits outside the interval.** If the computed |det| exceeds dd, the sign of det is certain. A computed h below -dh
/// then implies a negative t. Let T be an upper bound of `to`, converted to lengths of the scaled direction. The
/// computed values of a hit at a t up to T satisfy h - T |det| <= dh + T dd. The bound dd also covers the rounding of
/// h - T |det|. The code uses the slack instead of dd. The slack is larger than dd, because 2 k is at least 160 w P.
///
/// **Bounds of `t`.** Let det' and h' be the computed values. If |det'| exceeds 16 dd, the error of t' = h' / |det'| is
/// at most 16/15 (dh + |t'| dd) / |det'|. The code uses 9/8 instead of 16/15 to cover the rounding of the error. The
/// code adds 8 w |t'| to cover the rounding of t' and of the bounds. [`TINY`] covers the underflow when the bounds are
/// multiplied by `scale`. No relevant value underflows earlier: m > 2 k implies |s| > 2^-18 E, and |det'| > 16 [`TINY`]
/// implies E > 2^-63, so the error exceeds 2^-104.
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

/// The first result contains only rays that do not hit the triangle at a `t` up to `to`.
///
/// One factor scales all directions. The proof of [`filter_block`] requires only that no scaled component exceeds 2 in
/// magnitude, and that a component that becomes denormal has an error of at most 2^-150.
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

/// If the first result of a lane is negative, the line does not meet the triangle at a `t` in [0, `last`].
///
/// `t` and `last` are in lengths of the scaled direction.
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

    // The error bounds are valid with and without fused operations.
    let p = direction.cross_loosely(edge2);
    let q = to_origin.cross_loosely(edge1);
    let det = edge1.dot_loosely(p);
    let u = to_origin.dot_loosely(p).flip_sign(det);
    let v = direction.dot_loosely(q).flip_sign(det);
    let abs_det = det.flip_sign(det);

    let distance = to_origin.abs_sum();
    let tiny = L::splat(scaling.tiny);
    let slack = distance.add(extent.add(extent)).mul_add_loosely(extent.mul_add_loosely(L::splat(SLACK), tiny), tiny);
    // If `u` or `v` is NaN, the argument of the second `min` is NaN. `min` returns the argument if either operand is
    // NaN.
    let least = u.min(v).min(abs_det.sub(u.add(v)));
    let outside = least.add(slack);

    let height = edge2.dot_loosely(q).flip_sign(det);
    let underflow = extent.mul_add_loosely(tiny, tiny);
    let height_error = area.mul_add_loosely(distance, underflow);
    let behind = slack.sub(abs_det).max(height.add(height_error));
    let beyond = slack.mul_add_loosely(last, height_error).add(last.mul_sub_loosely(abs_det, height));

    // A negative value in `signs` rejects the lane. NaN does not reject the lane. `extent` is negative in unused lanes.
    let signs = beyond.min(behind).min(outside).min(extent);
    let scale = scaling.scale;
    (signs, Candidates { height, height_error, abs_det, least, slack, area, underflow, scale })
}
