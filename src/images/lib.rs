//! The images of **sahara**: scenes with their meshes, cameras and rays, a renderer, and the comparison with golden
//! images. The trees are in [`sahara_core`], the command is in `sahara`, which re-exports most modules.

use sahara_core::{accel, geometry, oracle, triangle};
#[cfg(test)]
use sahara_core::{brute_force, kdtree};

pub mod escaped;
pub mod golden;
pub mod names;
pub mod output;
pub mod plural;
pub mod render;
pub mod scene;

// Callers need the same version of `image`.
pub use image;
