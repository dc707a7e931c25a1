use glam::{DVec3, Vec3};

use crate::geometry::Ray;

/// A point on a triangle, rounded to `f32`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfacePoint {
    pub position: Vec3,
    /// A bound of the distance to the triangle along each axis, at least 0.
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
    /// The weights are clamped and divided by their sum, so the point lies in the triangle except for rounding.
    ///
    /// `error` is pbrt's bound for `f32` arithmetic. The function computes in `f64`, so the bound has a margin for the
    /// rounding of triangle tests.
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

    /// The point, moved to the side of the triangle to which `direction` points. The additional float on each axis
    /// makes up for rounding.
    pub(super) fn moved_out(&self, direction: Vec3) -> Vec3 {
        let is_behind = self.normal.as_dvec3().dot(direction.as_dvec3()) < 0.0;
        let normal = if is_behind { -self.normal } else { self.normal };
        let moved = self.position + normal * normal.abs().dot(self.error);
        Vec3::from_array(std::array::from_fn(|axis| match normal[axis] {
            n if n > 0.0 => moved[axis].next_up(),
            n if n < 0.0 => moved[axis].next_down(),
            _ => moved[axis],
        }))
    }
}

/// Barycentric coordinates of the point where the ray's line meets the plane of the corners. If the line misses the
/// triangle, some coordinates are outside [0, 1].
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
