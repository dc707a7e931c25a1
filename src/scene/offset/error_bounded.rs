//! Moves the origin along the normal by the error bound of the point.
//!
//! Promises, for a point from [`SurfacePoint::on_triangle`] at any scale and place: the origin lies on the side of the
//! triangle's plane that the ray leaves to, so that exactly the triangle is not met again; and no farther from it than
//! some ten units in the last place of the largest coordinate of its corners, so that nothing else is passed. Does not
//! promise: another surface that is nearer than that may be passed.
//!
//! # References
//! Pharr, Jakob, Humphreys: Physically Based Rendering, 4th edition, 2023, section 6.8.6. We depart in two points, for
//! the sake of triangles in a plane of zero coordinates and of coordinates so small that the error vanishes: every
//! coordinate in which the normal has a part is moved on by one float, whether or not the offset has left something
//! there; and `t = 0` is excluded.

use glam::Vec3;

use super::SurfacePoint;

/// The least positive number.
pub const T_MIN: f32 = f32::from_bits(1);

/// The box of the error around the point, seen along the normal, is left behind; then one float more, against the
/// rounding of this sum.
pub fn origin(start: &SurfacePoint, direction: Vec3) -> Vec3 {
    let normal = start.towards(direction);
    let moved = start.position + normal * normal.abs().dot(start.error);
    Vec3::from_array(std::array::from_fn(|axis| match normal[axis] {
        n if n > 0.0 => moved[axis].next_up(),
        n if n < 0.0 => moved[axis].next_down(),
        _ => moved[axis],
    }))
}
