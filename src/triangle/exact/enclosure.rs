//! One triangle in `f64`, with bounds on the rounding.

use glam::{DVec3, Vec3};

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

/// Looks at the line of `ray` and a triangle: sides by triple products of the corners as seen from the origin, `t` from
/// the plane through the first corner.
///
/// **Bounds.** With n = 2^-53, a computed corner A = a - o is off by n of itself, a component of a cross product of two such
/// vectors by 4.1 n (|x||y'| + |y||x'|), a dot product with it adds 3 n. With the largest components X', Y' of X and Y, and |Z| the
/// sum of the components of Z, the triple product Z . (X x Y) is off by at most 2 |Z| X' Y' times 7.1 n when Z is given, and
/// times 8.1 n when it is itself a difference. The constants below leave 2 n for the rounding of the bounds. `f32` inputs neither
/// overflow nor underflow: products of three differences and a direction are below 2^520 and, if not zero, at least 2^-596.
#[inline(always)]
pub(super) fn look(ray: &Ray, corners: [Vec3; 3]) -> Sight {
    let (origin, direction) = (ray.origin.as_dvec3(), ray.direction.as_dvec3());
    let [first, second, third] = corners.map(Vec3::as_dvec3);
    let [a, b, c] = [first - origin, second - origin, third - origin];
    let [a_size, b_size, c_size] = [a, b, c].map(|p| p.abs().max_element());
    let length = sum(direction);

    // The sides of the edges: certainly opposite ones mean a miss.
    let volumes = [(c, b, c_size * b_size), (a, c, a_size * c_size), (b, a, b_size * a_size)];
    let (mut above, mut below, mut certain) = (false, false, true);
    for (p, q, size) in volumes {
        let volume = direction.dot(p.cross(q));
        let error = (2.0 * 9.0 * UNIT) * (length * size);
        above |= volume > error;
        below |= volume < -error;
        certain &= volume.abs() > error;
    }
    if above && below {
        return Sight::Miss;
    }
    if !certain {
        return Sight::Unclear;
    }

    // The plane.
    let (edge1, edge2) = (second - first, third - first);
    let normal = edge1.cross(edge2);
    let size = edge1.abs().max_element() * edge2.abs().max_element();
    let (height, height_error) = (a.dot(normal), (2.0 * 10.0 * UNIT) * (sum(a) * size));
    let (det, det_error) = (direction.dot(normal), (2.0 * 9.0 * UNIT) * (length * size));
    if det.abs() <= det_error {
        return Sight::Unclear;
    }

    // |h/d - h'/d'| <= (dh + |h'/d'| dd) / (|d'| - dd); the quotients and the sum round within 2^-50.
    let t = height / det;
    let error = (height_error + t.abs() * det_error) / (det.abs() - det_error);
    let error = error * (1.0 + 16.0 * UNIT) + t.abs() * (4.0 * UNIT);
    Sight::Hit { low: t - error, high: t + error }
}

fn sum(v: DVec3) -> f64 {
    let v = v.abs();
    v.x + v.y + v.z
}
