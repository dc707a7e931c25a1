//! Moves the origin by a number of floats along the normal, in the bits of each coordinate; close to zero by a length.
//!
//! Promises: no acne where the error of the point is a few units in the last place of its largest coordinate. Does not
//! promise: a scene smaller than the fixed length, 1/65536, is passed through as a whole, and a coordinate much smaller
//! than the others is moved by its own few units only. Costs three integer additions.
//!
//! # References
//! Wächter, Binder: A fast and robust method for avoiding self-intersection. Ray Tracing Gems, chapter 6, 2019. The
//! constants are theirs.

use glam::Vec3;

use super::SurfacePoint;

/// Below this magnitude a coordinate is moved by a length.
const NEAR_ZERO: f32 = 1.0 / 32.0;
const LENGTH: f32 = 1.0 / 65536.0;
const FLOATS: f32 = 256.0;

/// The moved point.
pub fn origin(start: &SurfacePoint, direction: Vec3) -> Vec3 {
    let (point, normal) = (start.position, start.towards(direction));
    Vec3::from_array(std::array::from_fn(|axis| {
        let (p, n) = (point[axis], normal[axis]);
        if p.abs() < NEAR_ZERO {
            return p + n * LENGTH;
        }
        // The bits of a float count its magnitude.
        let floats = (n * FLOATS) as i32;
        f32::from_bits(p.to_bits().wrapping_add_signed(if p < 0.0 { -floats } else { floats }))
    }))
}
