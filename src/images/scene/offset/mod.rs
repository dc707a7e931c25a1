//! Moves the origins of rays that leave a surface: far enough not to hit it again, near enough to miss no other
//! surface.

mod surface_point;

use glam::Vec3;

pub use surface_point::{SurfacePoint, barycentrics};

use crate::geometry::Ray;

/// The offset of the origins of secondary rays.
///
/// The point of a hit is rounded, so it lies a little before or behind the surface: half of the rays that start at it
/// hit their own surface again (acne). An origin with too large an offset passes through surfaces that the ray should
/// hit (leak).
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Offset {
    /// By this distance along the direction, including rays from the eye: the source report's course does this, with
    /// 0.01. A grazing ray leaves the surface slowly and may hit it again.
    Direction(f32),
    /// Along the normal by the error bound of the point.
    ///
    /// Guaranteed, for a point from [`SurfacePoint::on_triangle`] at any scale and place: the origin lies on the side of
    /// the triangle's plane to which the ray leaves, so the ray does not hit the triangle again; and at a distance of at
    /// most about ten units in the last place of the largest coordinate of its corners. The ray passes through another
    /// surface that is nearer than that.
    ///
    /// # References
    /// Pharr, Jakob, Humphreys: Physically Based Rendering, 4th edition, 2023, section 6.8.6. This version departs in two
    /// points, for triangles with a coordinate of zero and coordinates so small that the error bound underflows: every
    /// coordinate in which the normal is not zero moves by at least one float, and `t = 0` is excluded.
    ErrorBounded,
}

/// The least positive number: it excludes `t = 0`, where a hit belongs to the surface that the ray leaves.
const T_MIN: f32 = f32::from_bits(1);

impl Offset {
    /// The ray that leaves `start` in `direction`, which is normalised.
    ///
    /// It starts on the side of the triangle to which it leaves. Costs a few additions and multiplications.
    pub fn leave(self, start: &SurfacePoint, direction: Vec3) -> Ray {
        match self {
            Self::Direction(distance) => moved_along(start.position, direction, distance),
            Self::ErrorBounded => Ray { t_min: T_MIN, ..Ray::new(start.moved_out(direction), unit(direction)) },
        }
    }

    /// The ray that leaves `origin`, a point on no surface, in `direction`, which is normalised.
    pub fn leave_free(self, origin: Vec3, direction: Vec3) -> Ray {
        match self {
            Self::Direction(distance) => moved_along(origin, direction, distance),
            Self::ErrorBounded => Ray::new(origin, unit(direction)),
        }
    }
}

/// The course's offset, in `f32` throughout. Distances along the ray count from the moved origin.
fn moved_along(origin: Vec3, direction: Vec3, distance: f32) -> Ray {
    let direction = direction.normalize();
    Ray::new(origin + direction * distance, direction)
}

/// Normalises in `f64`, in which the square of no `f32` overflows or vanishes.
fn unit(direction: Vec3) -> Vec3 {
    direction.as_dvec3().normalize_or_zero().as_vec3()
}

#[cfg(test)]
mod tests;
