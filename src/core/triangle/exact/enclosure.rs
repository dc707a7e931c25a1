//! Intersects a line and a triangle in `f64`, with bounds on the rounding errors.

use glam::Vec3;

use crate::exact;
use crate::geometry::Ray;
use crate::simd::{Arithmetic, LaneVec3, Lanes, Portable, each};

pub(super) enum Bounds {
    Miss,
    /// The line meets the closed triangle at an exact `t` in [`low`, `high`].
    Hit {
        low: f64,
        high: f64,
    },
    Unclear,
}

/// The unit roundoff of `f64`.
const UNIT: f64 = f64::EPSILON / 2.0;

/// Intersects the line of `ray` with a triangle by the Möller-Trumbore method.
///
/// **Notation.** Let o be the origin and d the direction. Let a, b and c be the corners. Let e = b - a, f = c - a and
/// s = o - a. Let u = s . (d x f), v = d . (s x e), det = e . (d x f), w = det - u - v and h = f . (s x e).
///
/// Let E bound the magnitudes of the components of e and f. Let D bound the magnitudes of the components of d. Let |s|
/// be the sum of the magnitudes of the components of s.
///
/// Let det be nonzero. If no two of u, v and w have opposite signs, the line meets the closed triangle at t = h / det.
///
/// **Bounds.** Let n = 2^-53. The errors of the computed values are at most:
///
/// - 14.2 n D E |s| for u and v,
/// - 42.6 n D E E for det,
/// - 9.2 n (4 D E |s| + 6 D E E) for w,
/// - 16.2 n E E |s| for h.
///
/// The code uses larger constants to cover the rounding of the bounds. `f32` inputs cause no overflow or underflow,
/// because products of three differences and a direction are 0 or between 2^-596 and 2^520 in magnitude.
#[inline(always)]
pub(super) fn look(ray: &Ray, corners: [Vec3; 3]) -> Bounds {
    let (origin, direction) = (ray.origin.as_dvec3(), ray.direction.as_dvec3());
    let [a, b, c] = each(&corners, |corner| corner.as_dvec3());
    let (to_origin, edge1, edge2) = (origin - a, b - a, c - a);
    let (p, q) = (direction.cross(edge2), to_origin.cross(edge1));
    let (det, u, v) = (edge1.dot(p), to_origin.dot(p), direction.dot(q));
    let w = det - u - v;

    let extent = edge1.abs().max(edge2.abs()).max_element();
    let distance = to_origin.abs().element_sum();
    let unit = UNIT * extent * direction.abs().max_element();
    let (side_error, third_error) = (16.0 * unit * distance, unit * (40.0 * distance + 60.0 * extent));
    let above = (u > side_error) | (v > side_error) | (w > third_error);
    let below = (u < -side_error) | (v < -side_error) | (w < -third_error);
    if above & below {
        return Bounds::Miss;
    }
    let certain = (u.abs() > side_error) & (v.abs() > side_error) & (w.abs() > third_error);
    let det_error = 48.0 * unit * extent;
    if det.abs() < 1024.0 * det_error || det == 0.0 {
        return Bounds::Unclear;
    }
    if !certain && passes_by(ray, corners, det, [(u, side_error), (v, side_error), (w, third_error)]) {
        return Bounds::Miss;
    }

    let height_error = 20.0 * UNIT * extent * extent * distance;
    let lane = Portable::<1, f64>::splat;
    let (low, high) = divide(lane(edge2.dot(q)), lane(height_error), lane(det), lane(det_error));
    Bounds::Hit { low: low.store()[0], high: high.store()[0] }
}

/// Bounds the exact `t` of a line that passes exactly through a corner.
///
/// Returns `None` if the line misses all corners. Returns `None` if the line may be parallel to the triangle.
#[inline(always)]
pub(super) fn look_at_corners(ray: &Ray, corners: [Vec3; 3]) -> Option<Bounds> {
    let corner = corners.into_iter().find(|&corner| exact::passes_through(ray, corner))?;
    let (det, error) = determinant(ray, corners);
    (det.abs() > error).then(|| at_height(corner, ray, ray.direction.abs().max_position()))
}

/// Returns the computed value of -det and an error bound, in the notation of [`look`].
#[inline(always)]
fn determinant(ray: &Ray, corners: [Vec3; 3]) -> (f64, f64) {
    let direction = ray.direction.as_dvec3();
    let [a, b, c] = each(&corners, |corner| corner.as_dvec3());
    let (edge1, edge2) = (b - a, c - a);
    let extent = edge1.abs().max(edge2.abs()).max_element();
    (direction.dot(edge1.cross(edge2)), 48.0 * UNIT * extent * extent * direction.abs().max_element())
}

/// Bounds the `t` at which the line crosses the plane through `point` perpendicular to `axis`.
///
/// The line must not be parallel to the plane. If the origin lies in the plane, both bounds are zero. The difference
/// and the division each have a relative error of at most 2^-53.
#[inline(always)]
fn at_height(point: Vec3, ray: &Ray, axis: usize) -> Bounds {
    let t = (f64::from(point[axis]) - f64::from(ray.origin[axis])) / f64::from(ray.direction[axis]);
    let error = t.abs() * (4.0 * UNIT);
    Bounds::Hit { low: t - error, high: t + error }
}

/// Whether u, v or w of [`look`] has a sign opposite to the sign of det. The sign of det must be certain.
#[inline(always)]
fn passes_by(ray: &Ray, [a, b, c]: [Vec3; 3], det: f64, [u, v, w]: [(f64, f64); 3]) -> bool {
    let sign = det.total_cmp(&0.0);
    let is_opposite = |(x, error): (f64, f64), from: Vec3, to: Vec3| {
        let side = if x.abs() > error { x.total_cmp(&0.0) } else { exact::side(ray, [from, to]) };
        side == sign.reverse()
    };
    is_opposite(u, a, c) || is_opposite(v, b, a) || is_opposite(w, c, b)
}

/// Bounds the exact `t` in each lane. The line in a lane must meet the triangle in this lane.
///
/// The bits of the first result mark the lanes with valid bounds.
///
/// **Bounds.** In the notation of [`look`], h = s . (e x f) and det = -d . (e x f). The error of h is at most
/// 16.2 n E E |s|. The error of det is at most 42.6 n D E E.
#[inline(always)]
pub(super) fn place<const N: usize, L: Lanes<N>>(
    origin: LaneVec3<N, L>,
    direction: LaneVec3<N, L>,
    corners: [LaneVec3<N, L>; 3],
) -> (u32, L::Double, L::Double) {
    let (direction, [a, b, c]) = (direction.widen(), each(&corners, |corner| corner.widen()));
    let (to_origin, edge1, edge2) = (origin.widen() - a, b - a, c - a);
    let normal = edge1.cross(edge2);
    let (height, det) = (to_origin.dot(normal), L::Double::zero().sub(direction.dot(normal)));

    let times = |x: L::Double, factor: f64| x.mul(L::Double::splat(factor));
    let extent = edge1.abs_max().max(edge2.abs_max());
    let scale = times(extent.mul(extent), UNIT);
    let height_error = times(scale.mul(to_origin.abs_sum()), 20.0);
    let det_error = times(scale.mul(direction.abs_max()), 48.0);
    let (low, high) = divide(height, height_error, det, det_error);
    (times(det_error, 1024.0).le(det.flip_sign(det)), low, high)
}

/// Bounds the exact `t` for a triangle in an axis-aligned plane. The line must meet the triangle.
///
/// Returns `None` for all other triangles. Returns `None` if the line is parallel to the plane.
#[inline(always)]
pub(super) fn place_in_axis_plane(ray: &Ray, [a, b, c]: &[Vec3; 3]) -> Option<Bounds> {
    let across = a.cmpeq(*b) & a.cmpeq(*c) & ray.direction.cmpne(Vec3::ZERO);
    let axis = (across.bitmask() != 0).then(|| across.bitmask().trailing_zeros() as usize)?;
    Some(at_height(*a, ray, axis))
}

/// Bounds the exact `t` in each lane. The line in a lane must meet the triangle in this lane.
///
/// `width` is the distance between the bounds of `t` from `filter.rs`. Without these bounds, `width` must be infinite.
///
/// **Bounds.** Let n = 2^-53. In the notation of `filter_block`, the error of h is less than 8.1 n P |s|. The error of
/// det is less than 21.3 n D P. `filter_block` allows an error of 10 w P |s| in h, with w = 2^-24. `filter_block`
/// allows an error of 30 w D P in det. Hence 2^-30 `width` covers the errors of h and det. Another 2^-30 `width` covers
/// the rounding of `width`. 2^-50 |t| covers the rounding of the later operations.
#[inline(always)]
pub(super) fn pass_plane<const N: usize, L: Lanes<N>>(
    origin: LaneVec3<N, L>,
    direction: LaneVec3<N, L>,
    corners: [LaneVec3<N, L>; 3],
    width: L,
) -> (L::Double, L::Double) {
    let (origin, direction, [a, b, c]) = (origin.widen(), direction.widen(), each(&corners, |corner| corner.widen()));
    let normal = (b - a).cross_loosely(c - a);
    let t = (a - origin).dot_loosely(normal).div(direction.dot_loosely(normal));
    let error = width
        .widen()
        .mul_add_loosely(L::Double::splat(2.0_f64.powi(-29)), t.flip_sign(t).mul(L::Double::splat(2.0_f64.powi(-50))));
    (t.sub(error), t.add(error))
}

/// Bounds the exact `t` with [`exact::height`]. The line must meet the triangle.
///
/// The relative error of [`exact::height`] is below 2^-49. If the origin lies in the plane of the triangle, the bounds
/// of a `Hit` are zero.
pub(super) fn place_closely(ray: &Ray, corners: [Vec3; 3]) -> Bounds {
    let (det, det_error) = determinant(ray, corners);
    if det.abs() < 1024.0 * det_error || det == 0.0 {
        return Bounds::Unclear;
    }
    let height = exact::height(ray.origin, corners);
    let lane = Portable::<1, f64>::splat;
    let (low, high) = divide(lane(height), lane(8.0 * f64::EPSILON * height.abs()), lane(det), lane(det_error));
    Bounds::Hit { low: low.store()[0], high: high.store()[0] }
}

/// Bounds the quotient of two exact numbers. `height` and `det` are approximations of these numbers.
///
/// `height_error` and `det_error` bound the errors of the approximations. `det_error` must be at most 2^-10 |`det`|.
///
/// The error of t = `height` / `det` is at most (`height_error` + |t| `det_error`) / (|`det`| - `det_error`). Rounding
/// adds at most 2^-50 |t|.
#[inline(always)]
fn divide<const N: usize, D: Arithmetic<N, Scalar = f64>>(height: D, height_error: D, det: D, det_error: D) -> (D, D) {
    let abs = |x: D| x.flip_sign(x);
    let inverse = D::splat(1.0).div(det);
    let t = height.mul(inverse);
    let widest = height_error.add(abs(t).mul(det_error)).mul(abs(inverse).mul(D::splat(1.0 + 1.0 / 512.0)));
    let error = widest.add(abs(t).mul(D::splat(8.0 * UNIT)));
    (t.sub(error), t.add(error))
}

#[cfg(test)]
mod tests {
    use glam::Vec3Swizzles as _;

    use super::*;

    #[test]
    fn in_an_axis_aligned_plane_the_bounds_hold_the_exact_depth_and_zero_is_zero() {
        let flat = |height: f32| [[0.0, 0.0], [3.0, 1.0], [1.0, 2.5]].map(|[x, z]| Vec3::new(x, height, z));
        let mut zeros = 0;
        for height in [0.0, 0.1, -7.3, 1e-20, 3e12] {
            for origin in [height, f32::next_up(height), f32::next_down(height), 1.0, -1e-30] {
                for direction in [Vec3::new(0.1, -0.7, 0.2), Vec3::new(1e-3, 1e-7, -1e-3), Vec3::Y] {
                    for turn in [|p: Vec3| p, |p: Vec3| p.yzx(), |p: Vec3| p.zxy()] {
                        let ray = Ray::new(turn(Vec3::new(1.2, origin, 1.1)), turn(direction));
                        let corners = flat(height).map(turn);
                        let Some(exact) = exact::hit(&ray, corners) else { continue };
                        let Some(Bounds::Hit { low, high }) = place_in_axis_plane(&ray, &corners) else {
                            panic!("{ray}")
                        };
                        let t = exact.approximate();
                        assert!((low..=high).contains(&t), "{ray}: {t} not in [{low}, {high}]");
                        assert_eq!((low == 0.0, high == 0.0), (origin == height, origin == height), "{ray}");
                        zeros += usize::from(low == 0.0);
                    }
                }
            }
        }
        assert!(zeros > 10, "{zeros}");
        let along = Ray::new(Vec3::ZERO, Vec3::X);
        assert!(place_in_axis_plane(&along, &flat(0.0)).is_none());
        let tilted = [Vec3::ZERO, Vec3::X, Vec3::new(0.0, 1.0, 1.0)];
        assert!(place_in_axis_plane(&Ray::new(Vec3::ONE, Vec3::Y), &tilted).is_none());
    }
}
