//! Point lights.

use glam::Vec3;

/// A point light. Its light at distance `d` is `colour / (quadratic * d^2 + linear * d + 1)`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Light {
    pub position: Vec3,
    /// Linear RGB.
    pub colour: Vec3,
    /// `lat` in scene files: attenuation in proportion to the distance. With 0, there is none.
    pub linear: f32,
    /// `qat` in scene files: attenuation in proportion to the squared distance. With 0, there is none.
    pub quadratic: f32,
}

impl Light {
    /// The light that arrives at `distance` if nothing occludes it.
    pub fn at(&self, distance: f32) -> Vec3 {
        self.colour / (self.quadratic * distance * distance + self.linear * distance + 1.0)
    }
}
