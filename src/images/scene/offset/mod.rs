//! Moves the origins of secondary rays off the surface.

mod surface_point;

use glam::Vec3;

pub use surface_point::{SurfacePoint, barycentrics};

use crate::geometry::Ray;

/// A rounded hit point may lie behind the surface. A ray from this point can hit the surface again (acne). If the
/// origin moves too far, the ray can miss nearby surfaces (leak).
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Offset {
    /// Moves every origin, including the eye, by this distance along the ray direction. A grazing ray may hit the
    /// surface that it leaves. The source report uses a distance of 0.01, and its ray counts depend on this distance.
    Direction(f32),
    /// Moves the origin along the normal by the error bound of the point. The origins of camera rays do not move.
    ///
    /// For a point from [`SurfacePoint::on_triangle`], at any scale and position, the origin lies on the side of the
    /// triangle's plane to which the ray leaves. The ray therefore does not hit the triangle again. The origin moves by
    /// at most about 12 units in the last place of the largest corner coordinate. The ray may miss surfaces within this
    /// distance.
    ///
    /// # References
    /// Pharr, Jakob, Humphreys: Physically Based Rendering, 4th edition, 2023, section 6.8.6. Two changes handle error
    /// bounds that are 0 (a coordinate is 0 at all corners) or underflow. The origin moves by at least one float on
    /// each axis on which the normal is not 0, and `t = 0` is excluded.
    ErrorBounded,
}

/// The smallest positive `f32`. This value excludes a hit at `t = 0` on the surface that the ray leaves.
const T_MIN: f32 = f32::from_bits(1);

impl Offset {
    /// `direction` must not be zero. The direction of the returned ray has unit length.
    pub fn leave(self, start: &SurfacePoint, direction: Vec3) -> Ray {
        match self {
            Self::Direction(distance) => moved_along(start.position, direction, distance),
            Self::ErrorBounded => Ray { t_min: T_MIN, ..Ray::new(start.moved_out(direction), unit(direction)) },
        }
    }

    /// Like [`leave`](Self::leave), but from a point `origin` that lies on no surface.
    pub fn leave_free(self, origin: Vec3, direction: Vec3) -> Ray {
        match self {
            Self::Direction(distance) => moved_along(origin, direction, distance),
            Self::ErrorBounded => Ray::new(origin, unit(direction)),
        }
    }
}

/// Computed in `f32`. The parameter `t` of the ray counts from the moved origin.
fn moved_along(origin: Vec3, direction: Vec3, distance: f32) -> Ray {
    let direction = direction.normalize();
    Ray::new(origin + direction * distance, direction)
}

/// Squares of `f32` values neither overflow nor underflow in `f64`.
fn unit(direction: Vec3) -> Vec3 {
    direction.as_dvec3().normalize_or_zero().as_vec3()
}

#[cfg(test)]
mod tests;
