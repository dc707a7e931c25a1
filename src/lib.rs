//! **sahara** (SAH And Ray Acceleration): benchmark and validate ray-tracing acceleration structures, and compare
//! pictures with golden images.
//!
//! The README describes the command. This page is for authors of renderers and for authors of structures.
//!
//! # The trees in a renderer
//!
//! The trees are a separate crate, [`sahara_core`], with five small dependencies. This crate re-exports the modules of
//! `sahara_core` under the same names.
//!
#![doc = include_str!("WALK_THROUGH_1_STRUCTURE.md")]
#![doc = "```"]
#![doc = include_str!("../tests/third_party/grid.rs")]
#![doc = "```"]
#![doc = include_str!("WALK_THROUGH_2_COMMAND_AND_TESTS.md")]

pub use sahara_core::{
    accel, brute_force, build, bvh8, exact, external, geometry, kdtree, offered, oracle, simd, triangle,
};

use sahara_images::{escaped, names, plural};
pub use sahara_images::{golden, output, render, scene};

pub mod builtin;
pub mod cli;
pub mod fetch;
pub mod measure;
#[cfg(feature = "page")]
pub mod page;
mod panics;
pub mod registry;
pub mod report;
pub mod request;
pub mod runner;
pub mod study;
pub mod validate;

// Structures and studies in other crates should use these versions.
pub use anyhow;
pub use clap;
pub use glam;
pub use image;
pub use serde;
