//! A generated dragon mesh in place of the scanned dragon, which we are not permitted to copy.

mod body;
mod head;

use glam::Vec3;

use super::sdf::{Sdf, split_to};
use super::{fit::fit, noise};
use crate::geometry::Aabb;
use crate::scene::Model;

/// The triangle count of the dragon in the source report, a student report that this project reproduces.
const TRIANGLES: usize = 130_858;

const BOUNDS: Aabb = Aabb { min: Vec3::new(-0.102, 0.0, -0.046), max: Vec3::new(0.102, 0.144, 0.046) };

/// In units of the distance function. The distance function is 20 times as large as `BOUNDS`.
const STEP: f32 = 0.0221;

/// A closed dragon that stands on y = 0 and faces +x.
pub fn dragon() -> Model {
    let mut sdf = Sdf::new(0.012, pebbled);
    let spine = body::model(&mut sdf);
    head::model(&mut sdf, spine);

    let bounds = Aabb { min: Vec3::new(-2.4, -0.1, -1.3), max: Vec3::new(2.6, 3.4, 1.4) };
    let mut model = sdf.surface(bounds, STEP, 2);
    split_to(&mut model, TRIANGLES);
    fit(&mut model, BOUNDS);
    model
}

fn pebbled(p: Vec3) -> f32 {
    let (first, second) = noise::pebbles(p * 13.0, 7);
    0.012 * ((second - first) * 3.0).min(1.0) - 0.004
}
