//! Moves the origins of rays that leave a surface: far enough not to hit it again, near enough to miss nothing else.

pub mod error_bounded;
mod surface_point;
pub mod wachter_binder;

use glam::Vec3;

pub use surface_point::{SurfacePoint, barycentrics};

use crate::geometry::Ray;

/// A way to start secondary rays. `sahara study self-intersection` measures them against each other.
///
/// A ray that starts on a surface as computed starts, exactly, before or behind it: half of all rays meet their own
/// surface again (acne). A start that is moved too far passes through what it should meet (leak).
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Offset {
    /// At the point as computed. Promises nothing; costs nothing.
    None,
    /// Moved by this distance along the normal, to the side that the ray leaves to: right for one scale only.
    Normal(f32),
    /// At the point as computed, but without hits before this `t`; directions have unit length, so that it is a length
    /// of the scene too. A grazing ray leaves the surface slowly, and meets it again behind `t`.
    TMin(f32),
    /// Moved by this distance along the direction, rays from the eye included: the source report's course, with 0.01.
    /// As [`Offset::TMin`].
    Direction(f32),
    /// Moved by some units in the last place along the normal: [`wachter_binder`].
    WachterBinder,
    /// Moved by the error bound of the point: [`error_bounded`]. The only one that is right at every scale and place.
    ErrorBounded,
}

impl Offset {
    /// As written in tables and records.
    pub fn name(self) -> String {
        match self {
            Self::None => "none".into(),
            Self::Normal(distance) => format!("normal {distance:e}"),
            Self::TMin(t) => format!("t_min {t:e}"),
            Self::Direction(distance) => format!("direction {distance:e}"),
            Self::WachterBinder => "waechter-binder".into(),
            Self::ErrorBounded => "error-bounded".into(),
        }
    }

    /// The ray that leaves `start` in `direction`, which is brought to unit length.
    ///
    /// It starts on the side of the triangle that it leaves to. Costs a few additions and multiplications.
    pub fn leave(self, start: &SurfacePoint, direction: Vec3) -> Ray {
        let from = |origin: Vec3| Ray::new(origin, unit(direction));
        match self {
            Self::None => from(start.position),
            Self::Normal(distance) => from(start.position + start.towards(direction) * distance),
            Self::TMin(t_min) => Ray { t_min, ..from(start.position) },
            Self::Direction(distance) => moved_along(start.position, direction, distance),
            Self::WachterBinder => from(wachter_binder::origin(start, direction)),
            // What touches the start itself is the surface that the ray leaves.
            Self::ErrorBounded => Ray { t_min: error_bounded::T_MIN, ..from(error_bounded::origin(start, direction)) },
        }
    }

    /// The ray that leaves `origin`, a point on no surface, in `direction`, which is brought to unit length.
    pub fn leave_free(self, origin: Vec3, direction: Vec3) -> Ray {
        match self {
            Self::Direction(distance) => moved_along(origin, direction, distance),
            _ => Ray::new(origin, unit(direction)),
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
