//! A dragon, in place of the scanned one that may not be copied: a coiled serpent body on four legs, in one closed skin.

mod body;
mod head;

use glam::Vec3;

use super::{
    clay::{Clay, Skin, split_to},
    noise,
};
use crate::{geometry::Aabb, scene::Model};

/// As many as the dragon of the source report has.
const TRIANGLES: usize = 130_858;

/// The box of the model.
const BOUNDS: Aabb = Aabb { min: Vec3::new(-0.102, 0.0, -0.046), max: Vec3::new(0.102, 0.144, 0.046) };

/// Edge length of the net over the clay.
const STEP: f32 = 0.0221;

/// An evenly tessellated, closed dragon of 130,858 triangles with smooth normals, about 0.2 wide, standing on y = 0.
///
/// The clay is modelled 20 times as large, as the scene shows it. It looks to +x and a little to +z. The relief is of
/// scales on the body and pebbled skin elsewhere.
pub fn dragon() -> Model {
    let mut clay = Clay::new(0.012, skin_relief);
    let spine = body::model(&mut clay);
    head::model(&mut clay, spine);

    let bounds = Aabb { min: Vec3::new(-2.4, -0.1, -1.3), max: Vec3::new(2.6, 3.4, 1.4) };
    let mut skin = Skin::of(&clay, bounds, STEP, 2);
    split_to(&mut skin, TRIANGLES);
    skin.into_model(BOUNDS)
}

/// Pebbles with furrows between them.
fn skin_relief(p: Vec3) -> f32 {
    let (first, second) = noise::pebbles(p * 13.0, 7);
    0.012 * ((second - first) * 3.0).min(1.0) - 0.004
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::meshes::checks;

    #[test]
    fn the_dragon_is_one_closed_skin_of_the_promised_size() {
        let model = dragon();
        let mesh = checks::sound(&model, TRIANGLES);
        assert_eq!(mesh.bounds(), BOUNDS);
        assert_eq!(checks::closed_pieces(&model), 1);
        assert_eq!(checks::fingerprint(&model), "355d211535ade223");
    }
}
