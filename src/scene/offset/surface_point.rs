use glam::{DVec3, Vec3};

use crate::geometry::Ray;

/// A point on a triangle, from which rays leave.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfacePoint {
    /// The point as computed.
    pub position: Vec3,
    /// How far a point made from barycentrics may be from the triangle, along each axis. Not negative.
    pub error: Vec3,
    /// Unit normal of the triangle, either way; zero on a degenerate one.
    pub normal: Vec3,
}

/// The rounding of seven operations in `f32`, relative: with `u = 2^-24`, 7 u / (1 - 7 u).
const GAMMA_7: f32 = {
    let u = 0.5 * f32::EPSILON as f64;
    (7.0 * u / (1.0 - 7.0 * u)) as f32
};

impl SurfacePoint {
    /// The point of the triangle with these weights of its corners, whose sum is 1 and which are brought into [0, 1].
    ///
    /// The point is a mean of the corners: however wrong the weights are, it lies in the triangle but for the rounding
    /// of this mean. `origin + t * direction` instead is as wrong as `t`, however far the ray has come.
    ///
    /// `error` is that of pbrt, gamma(7) times the sum of the magnitudes of what is added: enough for weights and a sum
    /// in `f32`. This sum is made in `f64` and rounded once; what is left over is for triangle tests that round
    /// distances from the start.
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

    /// The normal, turned to the side that a ray in `direction` leaves to.
    pub(super) fn towards(&self, direction: Vec3) -> Vec3 {
        if self.normal.as_dvec3().dot(direction.as_dvec3()) < 0.0 { -self.normal } else { self.normal }
    }
}

/// Weights of the corners where the line of the ray meets their plane, by Cramer's rule in `f64`; equal ones when it
/// runs in the plane. Outside of [0, 1] where it passes the triangle by.
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
