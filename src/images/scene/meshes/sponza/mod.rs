//! A two-storey arcaded court. It replaces the Sponza model, which we are not permitted to copy.
//!
//! The tessellation is uneven, as in most models of architecture.

mod arcade;
mod column;
mod shell;

use glam::Vec3;

use super::{patches::Patches, sdf::Frame};
use crate::scene::{Material, Model};

/// The triangle count of the Sponza model in the source report.
const TRIANGLES: usize = 174_838;

/// Half length of the court along x, half width along z, and z of the middle.
const COURT: [f32; 3] = [1248.0, 215.0, -38.0];

const WALK: f32 = 280.0;

const UPPER: f32 = 470.0;

const EAVES: f32 = 900.0;

/// Column spacing of the lower storey along the two long sides.
const BAY: f32 = 208.0;

/// The court's floor is at y = 0. The mesh is not closed.
pub fn sponza() -> Model {
    let mut patches = Patches::default();
    let [half_length, half_width, middle] = COURT;
    let side = |x: f32, z: f32, ahead: Vec3| Frame::looking(Vec3::new(x, 0.0, z), ahead, Vec3::Y);

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

fn material(name: &str, tint: [f32; 3]) -> Material {
    Material {
        ambient: Vec3::splat(0.588),
        diffuse: Vec3::from(tint) * 0.588,
        specular: Vec3::ZERO,
        shininess: 9.803_922,
        ..Material::named(name)
    }
}
