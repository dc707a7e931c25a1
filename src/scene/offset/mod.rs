//! Moves the origins of rays that leave a surface: far enough not to hit it again, near enough to miss nothing else.

pub mod error_bounded;
mod surface_point;

use glam::Vec3;

pub use surface_point::{SurfacePoint, barycentrics};

use crate::geometry::Ray;

/// How the origins of secondary rays are offset.
///
/// The point of a hit is rounded, so it lies a little before or behind the surface: half of the rays that start at it
/// hit their own surface again (acne). An origin that is offset too far passes through what the ray should hit (leak).
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Offset {
    /// By this distance along the direction, rays from the eye included: the source report's course does it, with 0.01.
    /// A grazing ray leaves the surface slowly and may hit it again.
    Direction(f32),
    /// By the error bound of the point: [`error_bounded`], right at every scale and place.
    ErrorBounded,
}

impl Offset {
    /// The ray that leaves `start` in `direction`, which is brought to unit length.
    ///
    /// It starts on the side of the triangle that it leaves to. Costs a few additions and multiplications.
    pub fn leave(self, start: &SurfacePoint, direction: Vec3) -> Ray {
        match self {
            Self::Direction(distance) => moved_along(start.position, direction, distance),
            // A hit at the origin itself is one of the surface that the ray leaves.
            Self::ErrorBounded => {
                let origin = error_bounded::origin(start, direction);
                Ray { t_min: error_bounded::T_MIN, ..Ray::new(origin, unit(direction)) }
            }
        }
    }

    /// The ray that leaves `origin`, a point on no surface, in `direction`, which is brought to unit length.
    pub fn leave_free(self, origin: Vec3, direction: Vec3) -> Ray {
        match self {
            Self::Direction(distance) => moved_along(origin, direction, distance),
            Self::ErrorBounded => Ray::new(origin, unit(direction)),
        }
    }
}

/// As the course does it, in `f32` throughout. Distances along the ray count from the moved origin.
fn moved_along(origin: Vec3, direction: Vec3, distance: f32) -> Ray {
    let direction = direction.normalize();
    Ray::new(origin + direction * distance, direction)
}

/// Through `f64`, where the square of no `f32` overflows or vanishes.
fn unit(direction: Vec3) -> Vec3 {
    direction.as_dvec3().normalize_or_zero().as_vec3()
}

#[cfg(test)]
mod tests;
