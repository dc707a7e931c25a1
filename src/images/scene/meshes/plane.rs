//! Meshes made of squares: a plane, a cube, the Cornell box.

use glam::Vec3;

use super::{flat, halves};
use crate::scene::{Material, Model};

pub fn plane_y() -> Model {
    let corner = |x, z| Vec3::new(x, 0.0, z);
    let corners = vec![corner(-1.0, 1.0), corner(1.0, 1.0), corner(1.0, -1.0), corner(-1.0, -1.0)];
    flat(corners, halves([0, 1, 2, 3]).to_vec())
}

fn cube_corners() -> Vec<Vec3> {
    let sign = |i: u32, bit: u32| if i >> bit & 1 == 1 { 1.0 } else { -1.0 };
    (0..8).map(|i| Vec3::new(sign(i, 0), sign(i, 1), sign(i, 2))).collect()
}

pub fn cube() -> Model {
    let sides = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
    flat(cube_corners(), sides.into_iter().flat_map(halves).collect())
}

/// A cube without the side z = 1. The front of every triangle faces inward.
pub fn cornellbox() -> Model {
    let sides = [
        ("floor", [1, 0, 4, 5]),
        ("ceiling", [3, 7, 6, 2]),
        ("back", [2, 0, 1, 3]),
        ("right", [1, 5, 7, 3]),
        ("left", [6, 4, 0, 2]),
    ];
    Model {
        materials: sides.iter().map(|(part, _)| Material::named(*part)).collect(),
        material_of: (0..5).flat_map(|part| [part; 2]).collect(),
        ..flat(cube_corners(), sides.into_iter().flat_map(|(_, side)| halves(side)).collect())
    }
}
