//! Scenes, a renderer, and the comparison of pictures with golden images. [`sahara_core`] contains the acceleration
//! structures. `sahara` contains the command and re-exports most modules.

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

// Callers need this version of `image`.
pub use image;
