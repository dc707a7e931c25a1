//! The images of **sahara**: scenes with their meshes, cameras and rays; a renderer; the comparison of images with
//! golden ones. The crate [`sahara_core`] has the trees; the crate `sahara` has the command, and re-exports these modules.

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

// The version that this crate uses.
pub use image;
