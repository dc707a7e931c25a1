use glam::{DVec3, Vec3};

use crate::geometry::Ray;

/// A point on a triangle, rounded to `f32`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfacePoint {
    pub position: Vec3,
    /// A nonnegative bound of the error of `position` on each axis.
    pub error: Vec3,
    /// Unit normal on the front side. Zero if the triangle is degenerate.
    pub normal: Vec3,
}

/// A bound of the relative error of seven roundings in `f32`.
const GAMMA_7: f32 = {
    let u = 0.5 * f32::EPSILON as f64;
    (7.0 * u / (1.0 - 7.0 * u)) as f32
};

impl SurfacePoint {
    /// The function clamps the weights to [0, 1] and divides the weights by their sum.
    ///
    /// The point is a weighted mean of the corners. Except for rounding, it lies in the triangle even if `weights` are
    /// wrong. The error of `origin + t * direction` would grow with the length of the ray.
    ///
    /// `error` is the bound from pbrt, which suffices for weights and sums in `f32`. Here only the final rounding is to
    /// `f32`. The margin serves triangle tests that round the differences between corners and ray origin.
    ///
    /// # References
    /// Pharr, Jakob, Humphreys: Physically Based Rendering, 4th edition, 2023, section 6.8.
    pub fn on_triangle(corners: [Vec3; 3], weights: DVec3) -> Self {
        let [a, b, c] = corners.map(Vec3::as_dvec3);
        let weights = weights.clamp(DVec3::ZERO, DVec3::ONE);
        let weights = weights / weights.element_sum();
        let point = a * weights.x + b * weights.y + c * weights.z;
        let magnitude = a.abs() * weights.x + b.abs() * weights.y + c.abs() * weights.z;
        let normal = (b - a).cross(c - a).normalize_or_zero();
        Self { position: point.as_vec3(), error: magnitude.as_vec3() * GAMMA_7, normal: normal.as_vec3() }
    }

    /// Returns a point off the surface, on the side that `direction` points to.
    pub(super) fn moved_out(&self, direction: Vec3) -> Vec3 {
        let is_behind = self.normal.as_dvec3().dot(direction.as_dvec3()) < 0.0;
        let normal = if is_behind { -self.normal } else { self.normal };
        let moved = self.position + normal * normal.abs().dot(self.error);
        // `next_up` and `next_down` compensate for the rounding of `moved`.
        Vec3::from_array(std::array::from_fn(|axis| match normal[axis] {
            n if n > 0.0 => moved[axis].next_up(),
            n if n < 0.0 => moved[axis].next_down(),
            _ => moved[axis],
        }))
    }
}

/// Barycentric coordinates of the point where the ray's line meets the plane of the corners, by Cramer's rule. If the
/// line misses the triangle, some are outside [0, 1]. If the determinant is 0, all are 1/3.
pub fn barycentrics(ray: &Ray, corners: [Vec3; 3]) -> DVec3 {
    let [a, b, c] = corners.map(Vec3::as_dvec3);
    let (origin, direction) = (ray.origin.as_dvec3(), ray.direction.as_dvec3());
    let (ab, ac, from_a) = (b - a, c - a, origin - a);
    let p = direction.cross(ac);
    let determinant = ab.dot(p);
    if determinant == 0.0 {
        return DVec3::splat(1.0 / 3.0);
    }
    let v = from_a.dot(p) / determinant;
    let w = direction.dot(from_a.cross(ab)) / determinant;
    DVec3::new(1.0 - v - w, v, w)
}
