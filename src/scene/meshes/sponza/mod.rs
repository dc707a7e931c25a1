//! A two-storey arcaded court, in place of the Sponza model that may not be copied.
//!
//! Like real architecture, and unlike a scan, it is tessellated unevenly: huge wall triangles stand next to tiny ones in
//! capitals, balusters and roof tiles.

mod arcade;
mod column;
mod shell;

use glam::Vec3;

use super::{clay::Frame, stone::Stone};
use crate::scene::{Material, Model};

/// As many as the Sponza of the source report has.
const TRIANGLES: usize = 174_838;

/// Half length of the court along x, half width along z, and the z of its middle.
const COURT: [f32; 3] = [1248.0, 215.0, -38.0];

/// Depth of the walks behind the arcades.
const WALK: f32 = 280.0;

/// Floor of the upper storey.
const UPPER: f32 = 470.0;

/// Top of the upper arcade, where the eaves are.
const EAVES: f32 = 900.0;

/// Column spacing below; above, columns stand twice as close.
const BAY: f32 = 208.0;

/// A building of 174,838 triangles with an open court, 3721 long (x), 1555 high and 2288 wide, its court floor at y = 0.
///
/// Flat stone is flat-shaded, turned and curved stone has smooth normals. Not closed. Materials by name: floor, brick,
/// column_a, column_b, arch, trim, ornament, ceiling, wood, roof.
pub fn sponza() -> Model {
    let mut stone = Stone::default();
    let [half_length, half_width, middle] = COURT;
    let side = |x: f32, z: f32, ahead: Vec3| Frame::looking(Vec3::new(x, 0.0, z), ahead, Vec3::Y);

    // Each side of the court, seen from it: right along the arcade, ahead into the court.
    let long_bays = (2.0 * half_length / BAY) as usize;
    let sides = [
        (side(-half_length, middle - half_width, Vec3::Z), long_bays),
        (side(half_length, middle + half_width, Vec3::NEG_Z), long_bays),
        (side(-half_length, middle + half_width, Vec3::X), 2),
        (side(half_length, middle - half_width, Vec3::NEG_X), 2),
    ];
    for (frame, bays) in &sides {
        let bay = if *bays == 2 { half_width } else { BAY };
        arcade::build(&mut stone, frame, *bays, bay);
        shell::walk(&mut stone, frame, *bays, bay);
    }
    shell::grounds(&mut stone);
    shell::roofs(&mut stone, TRIANGLES);
    stone.model
}

/// Matt stone, with the reflection of all materials of the scene and a tint.
fn material(name: &str, tint: [f32; 3]) -> Material {
    Material {
        ambient: Vec3::splat(0.588),
        diffuse: Vec3::from(tint) * 0.588,
        specular: Vec3::ZERO,
        shininess: 9.803_922,
        ..Material::named(name)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{geometry::Aabb, scene::meshes::checks};

    #[test]
    fn the_court_is_sound_and_fills_its_box() {
        let model = sponza();
        let mesh = checks::sound(&model, TRIANGLES);
        let (min, max) = (Vec3::new(-1921.0, -126.0, -1183.0), Vec3::new(1800.0, 1429.0, 1105.0));
        assert_eq!(mesh.bounds(), Aabb { min, max });
        assert_eq!(model.materials.len(), 10);
        assert_eq!(checks::fingerprint(&model), "3bf9bc78684c66f7");
    }

    #[test]
    fn tessellation_is_uneven() {
        let model = sponza();
        let area = |t: &[u32; 3]| {
            let [a, b, c] = t.map(|i| model.positions[i as usize]);
            0.5 * (b - a).cross(c - a).length()
        };
        let mut areas: Vec<f32> = model.triangles.iter().map(area).collect();
        areas.sort_unstable_by(f32::total_cmp);
        assert!(areas[areas.len() - 1] > 1e5 * areas[areas.len() / 2]);
    }
}
