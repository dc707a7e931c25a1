//! A winged, draped figure that holds up a torch, in place of the scanned Lucy that may not be copied.

mod figure;
mod gown;
mod wings;

use glam::Vec3;

use super::clay::{Clay, Joint, Skin, split_to};
use crate::{geometry::Aabb, scene::Model};

/// As many as the statue of the source report has.
const TRIANGLES: usize = 275_690;

/// The box of the model.
const BOUNDS: Aabb = Aabb { min: Vec3::new(-6.74, 0.0, -3.87), max: Vec3::new(6.74, 23.15, 3.87) };

/// Edge length of the net over the clay.
const STEP: f32 = 0.0835;

/// An evenly tessellated, closed statue of 275,690 triangles with smooth normals, 23 high, standing on y = 0.
///
/// It looks to +z, the torch is in its right hand. The fine relief is in the folds of the gown and in the feathers.
pub fn lucy() -> Model {
    let mut clay = Clay::plain();
    gown::model(&mut clay);
    figure::model(&mut clay);
    wings::model(&mut clay);
    pedestal(&mut clay);

    let bounds = Aabb { min: Vec3::new(-7.4, -0.2, -4.6), max: Vec3::new(7.4, 23.8, 4.2) };
    let mut skin = Skin::of(&clay, bounds, STEP, 2);
    split_to(&mut skin, TRIANGLES);
    skin.into_model(BOUNDS)
}

/// A round base of three steps.
fn pedestal(clay: &mut Clay) {
    clay.part(Joint::smooth(0.08));
    for (low, high, radius) in [(0.0, 0.75, 3.5), (0.6, 1.35, 3.05), (1.2, 1.8, 3.2)] {
        let (middle, half) = (0.5 * (low + high), 0.5 * (high - low));
        clay.lump(Vec3::new(0.0, middle, 0.0), radius + half, move |p| {
            let out = (p.x * p.x + p.z * p.z).sqrt() - radius + 0.1;
            let up = (p.y - middle).abs() - half + 0.1;
            (out.max(0.0) * out.max(0.0) + up.max(0.0) * up.max(0.0)).sqrt() + out.max(up).min(0.0) - 0.1
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::meshes::checks;

    #[test]
    fn the_statue_is_one_closed_skin_of_the_promised_size() {
        let model = lucy();
        let mesh = checks::sound(&model, TRIANGLES);
        assert_eq!(mesh.bounds(), BOUNDS);
        assert_eq!(checks::closed_pieces(&model), 1);
        assert_eq!(checks::fingerprint(&model), "84b49e7f5aae0aa1");
    }
}
