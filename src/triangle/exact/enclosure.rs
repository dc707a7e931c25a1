//! One triangle in `f64`, with bounds on the rounding.

use glam::Vec3;

use crate::geometry::Ray;

/// What is certain of a ray and a triangle.
pub(super) enum Sight {
    Miss,
    /// The line meets the closed triangle at an exact `t` in [`low`, `high`].
    Hit {
        low: f64,
        high: f64,
    },
    /// Rounding hides it.
    Unclear,
}

/// 2^-53, by which a difference, a product and a sum are off, relatively.
const UNIT: f64 = f64::EPSILON / 2.0;

/// Looks at the line of `ray` and a triangle, by Möller-Trumbore.
///
/// **Bounds.** Let s = o - a, e and f the edges from a, u = s . (d x f), v = d . (s x e), det = e . (d x f), h = f . (s x e); the
/// line meets the closed triangle if u, v, w = det - u - v have no opposite signs and det is not zero, at t = h / det. With
/// n = 2^-53, E bounding the components of e and f, D those of d, and |s| the sum of those of s: differences of inputs, products and
/// sums are off by n of themselves, so that the components of d x f are off by 3.1 n 2 D E, the sum of those of s x e by
/// 4.1 n 2 E |s|, and hence u and v by 7.1 n 2 D E |s|, det by 7.1 n 6 D E E, w by the sum of these and 2 n of its terms,
/// 9.2 n (4 D E |s| + 6 D E E), and h by 8.1 n 2 E E |s|. The constants below are larger by more than the rounding of the bounds.
/// `f32` inputs neither overflow nor underflow: products of three differences and a direction are below 2^520 and, if not zero,
/// at least 2^-596.
#[inline(always)]
pub(super) fn look(ray: &Ray, corners: [Vec3; 3]) -> Sight {
    let (origin, direction) = (ray.origin.as_dvec3(), ray.direction.as_dvec3());
    let [a, b, c] = corners.map(Vec3::as_dvec3);
    let (to_origin, edge1, edge2) = (origin - a, b - a, c - a);
    let (p, q) = (direction.cross(edge2), to_origin.cross(edge1));
    let (det, u, v) = (edge1.dot(p), to_origin.dot(p), direction.dot(q));
    let w = det - u - v;

    // Certainly opposite signs mean a miss.
    let extent = edge1.abs().max(edge2.abs()).max_element();
    let distance = to_origin.abs().element_sum();
    let unit = UNIT * extent * direction.abs().max_element();
    let (side_error, third_error) = (16.0 * unit * distance, unit * (40.0 * distance + 60.0 * extent));
    let above = (u > side_error) | (v > side_error) | (w > third_error);
    let below = (u < -side_error) | (v < -side_error) | (w < -third_error);
    if above & below {
        return Sight::Miss;
    }
    let certain = (u.abs() > side_error) & (v.abs() > side_error) & (w.abs() > third_error);
    let det_error = 48.0 * unit * extent;
    if !certain || det.abs() < 1024.0 * det_error {
        return Sight::Unclear;
    }

    let height_error = 20.0 * UNIT * extent * extent * distance;
    divide(edge2.dot(q), height_error, det, det_error)
}

/// As [`look`], where the line is known to meet the triangle: `t` from its plane.
///
/// **Bounds.** In the notation of [`look`], the components of the normal e x f are off by 4.1 n 2 E E, so that h = s . (e x f) is
/// off by 8.1 n 2 E E |s|, and det = -d . (e x f) by 7.1 n 6 D E E.
#[inline(always)]
pub(super) fn place(ray: &Ray, corners: [Vec3; 3]) -> Sight {
    let (origin, direction) = (ray.origin.as_dvec3(), ray.direction.as_dvec3());
    let [a, b, c] = corners.map(Vec3::as_dvec3);
    let (to_origin, edge1, edge2) = (origin - a, b - a, c - a);
    let normal = edge1.cross(edge2);
    let (height, det) = (to_origin.dot(normal), -direction.dot(normal));

    let extent = edge1.abs().max(edge2.abs()).max_element();
    let scale = UNIT * extent * extent;
    let height_error = 20.0 * scale * to_origin.abs().element_sum();
    let det_error = 48.0 * scale * direction.abs().max_element();
    if det.abs() < 1024.0 * det_error { Sight::Unclear } else { divide(height, height_error, det, det_error) }
}

/// |h/d - h'/d'| <= (dh + |h'/d'| dd) / (|d'| - dd), where dd is at most 2^-10 |d'|; the rest rounds within 2^-50.
#[inline(always)]
fn divide(height: f64, height_error: f64, det: f64, det_error: f64) -> Sight {
    let inverse = 1.0 / det;
    let t = height * inverse;
    let error = (height_error + t.abs() * det_error) * (inverse.abs() * (1.0 + 1.0 / 512.0)) + t.abs() * (8.0 * UNIT);
    Sight::Hit { low: t - error, high: t + error }
}
