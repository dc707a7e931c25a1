//! A generated statue in place of the scanned statue Lucy, which we are not permitted to copy.

mod figure;
mod gown;
mod wings;

use glam::Vec3;

use super::fit::fit;
use super::sdf::{Blend, Sdf, rounded_intersection, split_to};
use crate::geometry::Aabb;
use crate::scene::Model;

/// The triangle count of the statue in the source report, a student report that this project reproduces.
const TRIANGLES: usize = 275_690;

const BOUNDS: Aabb = Aabb { min: Vec3::new(-6.74, 0.0, -3.87), max: Vec3::new(6.74, 23.15, 3.87) };

const STEP: f32 = 0.0835;

/// A closed statue that stands on y = 0 and faces +z.
pub fn lucy() -> Model {
    let mut sdf = Sdf::plain();
    gown::model(&mut sdf);
    figure::model(&mut sdf);
    wings::model(&mut sdf);
    pedestal(&mut sdf);

    let bounds = Aabb { min: Vec3::new(-7.4, -0.2, -4.6), max: Vec3::new(7.4, 23.8, 4.2) };
    let mut model = sdf.surface(bounds, STEP, 2);
    split_to(&mut model, TRIANGLES);
    fit(&mut model, BOUNDS);
    model
}

fn pedestal(sdf: &mut Sdf) {
    sdf.group(Blend::smooth(0.08));
    for (low, high, radius) in [(0.0, 0.75, 3.5), (0.6, 1.35, 3.05), (1.2, 1.8, 3.2)] {
        let (middle, half) = (0.5 * (low + high), 0.5 * (high - low));
        sdf.primitive(Vec3::new(0.0, middle, 0.0), radius + half, move |p| {
            let out = (p.x * p.x + p.z * p.z).sqrt() - radius + 0.1;
            let up = (p.y - middle).abs() - half + 0.1;
            rounded_intersection(out, up, 0.1)
        });
    }
}
