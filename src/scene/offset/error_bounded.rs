//! Moves the origin of a ray along the normal by the error bound of its point.
//!
//! Guaranteed, for a point from [`SurfacePoint::on_triangle`] at any scale and place: the origin lies on the side of
//! the triangle's plane to which the ray leaves, so the ray does not hit the triangle again; and at a distance of at
//! most about ten units in the last place of the largest coordinate of its corners. The ray passes through another
//! surface that is nearer than that.
//!
//! # References
//! Pharr, Jakob, Humphreys: Physically Based Rendering, 4th edition, 2023, section 6.8.6. This version departs in two
//! points, for triangles with a coordinate of zero and coordinates so small that the error bound underflows: every
//! coordinate in which the normal is not zero moves by at least one float, and `t = 0` is excluded.

use glam::Vec3;

use super::SurfacePoint;

/// The least positive number: it excludes `t = 0`.
pub const T_MIN: f32 = f32::from_bits(1);

/// Moves by the extent of the error box along the normal, then by one more float against the rounding of this sum.
pub fn origin(start: &SurfacePoint, direction: Vec3) -> Vec3 {
    let normal = start.towards(direction);
    let moved = start.position + normal * normal.abs().dot(start.error);
    Vec3::from_array(std::array::from_fn(|axis| match normal[axis] {
        n if n > 0.0 => moved[axis].next_up(),
        n if n < 0.0 => moved[axis].next_down(),
        _ => moved[axis],
    }))
}
