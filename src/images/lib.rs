//! Scenes, a renderer, and golden images, which are stored correct pictures. [`sahara_core`] contains the acceleration
//! structures.

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

// Public functions return types of `image`.
pub use image;
