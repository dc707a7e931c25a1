use glam::{DVec3, Vec3};

use crate::geometry::Ray;

/// A point on a triangle, from which rays leave.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfacePoint {
    /// The rounded point.
    pub position: Vec3,
    /// A bound, along each axis, of the distance between the rounded point and the triangle; at least 0.
    pub error: Vec3,
    /// Unit normal on the front side of the triangle; zero if the triangle is degenerate.
    pub normal: Vec3,
}

/// A bound of the relative error of seven roundings in `f32`: 7 u / (1 - 7 u) with `u = 2^-24`.
const GAMMA_7: f32 = {
    let u = 0.5 * f32::EPSILON as f64;
    (7.0 * u / (1.0 - 7.0 * u)) as f32
};

impl SurfacePoint {
    /// The point with the barycentric coordinates `weights`, which are clamped to [0, 1] and divided by their sum.
    ///
    /// The point is a weighted mean of the corners: even with wrong weights it lies in the triangle, except for the
    /// rounding of the mean. The error of `origin + t * direction`, in contrast, grows with the length of the ray.
    ///
    /// `error` is pbrt's bound: gamma(7) times the sum of the magnitudes of the terms. It suffices if the weights and
    /// the sum are computed in `f32`. Here they are computed in `f64`, and only the sum is rounded. The bound therefore
    /// has a margin for triangle tests that round the differences between corners and ray origin.
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

    /// The point, moved to the side of the triangle to which `direction` points. It moves along the normal by the
    /// extent of the error box. The result is rounded, so it moves one float more on each axis with a nonzero normal.
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

/// The barycentric weights of the point where the line of the ray meets the plane of the corners, by Cramer's rule in
/// `f64`. If the line misses the triangle, some weights are outside [0, 1]. If the determinant is 0, all are 1/3.
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
