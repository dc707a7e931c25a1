//! Point lights.

use glam::Vec3;

/// The light at distance `d` is `colour / (quadratic * d^2 + linear * d + 1)`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Light {
    pub position: Vec3,
    /// Linear RGB.
    pub colour: Vec3,
    /// The key `lat` in scene files.
    pub linear: f32,
    /// The key `qat` in scene files.
    pub quadratic: f32,
}

impl Light {
    pub fn at(&self, distance: f32) -> Vec3 {
        self.colour / (self.quadratic * distance * distance + self.linear * distance + 1.0)
    }
}
