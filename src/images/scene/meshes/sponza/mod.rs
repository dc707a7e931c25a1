//! A two-storey arcaded court. It replaces the Sponza model, which may not be copied.
//!
//! Like most models of architecture, and unlike scans, it is tessellated unevenly: large triangles in walls are next to
//! small triangles in capitals, balusters and roof tiles.

mod arcade;
mod column;
mod shell;

use glam::Vec3;

use super::{patches::Patches, sdf::Frame};
use crate::scene::{Material, Model};

/// The number of triangles of the source report's Sponza.
const TRIANGLES: usize = 174_838;

/// Half length of the court along x, half width along z, and z of its middle.
const COURT: [f32; 3] = [1248.0, 215.0, -38.0];

const WALK: f32 = 280.0;

const UPPER: f32 = 470.0;

/// Top of the upper arcade, at the eaves.
const EAVES: f32 = 900.0;

/// Column spacing of the lower storey; it is half as large in the upper storey.
const BAY: f32 = 208.0;

/// A building of 174,838 triangles around an open court. Its box is 3721 x 1555 x 2288 units; the court's floor is at y
/// = 0. Flat stone is flat-shaded; turned and curved stone has smooth normals. The mesh is not closed.
pub fn sponza() -> Model {
    let mut patches = Patches::default();
    let [half_length, half_width, middle] = COURT;
    let side = |x: f32, z: f32, ahead: Vec3| Frame::looking(Vec3::new(x, 0.0, z), ahead, Vec3::Y);

    // The frames of the court's sides: the right axis runs along the arcade, the ahead axis points into the court.
    let long_bays = (2.0 * half_length / BAY) as usize;
    let sides = [
        (side(-half_length, middle - half_width, Vec3::Z), long_bays),
        (side(half_length, middle + half_width, Vec3::NEG_Z), long_bays),
        (side(-half_length, middle + half_width, Vec3::X), 2),
        (side(half_length, middle - half_width, Vec3::NEG_X), 2),
    ];
    for (frame, bays) in &sides {
        let bay = if *bays == 2 { half_width } else { BAY };
        arcade::build(&mut patches, frame, *bays, bay);
        shell::walk(&mut patches, frame, *bays, bay);
    }
    shell::grounds(&mut patches);
    shell::roofs(&mut patches, TRIANGLES);
    patches.model
}

/// Matt stone: all materials of the scene reflect 0.588 of the light, multiplied by `tint`.
fn material(name: &str, tint: [f32; 3]) -> Material {
    Material {
        ambient: Vec3::splat(0.588),
        diffuse: Vec3::from(tint) * 0.588,
        specular: Vec3::ZERO,
        shininess: 9.803_922,
        ..Material::named(name)
    }
}
