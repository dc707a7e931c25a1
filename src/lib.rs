//! **sahara** (SAH And Ray Acceleration): benchmark, validate and image-test ray-tracing acceleration structures.
//!
//! The command is described in the README. This page is for those who use the trees in a renderer, or bring a structure of
//! their own.
//!
//! # The trees in a renderer
//!
//! They are a crate of their own, [`sahara_core`], on five small libraries. Its modules are found here under the same names.
//!
#![doc = include_str!("WALK_THROUGH_1_STRUCTURE.md")]
#![doc = "```"]
#![doc = include_str!("../tests/third_party/grid.rs")]
#![doc = "```"]
#![doc = include_str!("WALK_THROUGH_2_COMMAND_AND_TESTS.md")]

// The core.
pub use sahara_core::{accel, brute_force, build, bvh8, exact, external, geometry, kdtree, offered, simd, triangle};

// The suite.
pub mod cli;
mod escaped;
pub mod fetch;
pub mod golden;
pub mod measure;
mod names;
pub mod oracle;
pub mod output;
#[cfg(feature = "page")]
pub mod page;
mod panics;
pub mod registry;
pub mod render;
pub mod report;
pub mod request;
pub mod runner;
pub mod scene;
pub mod study;
pub mod validate;

// What a structure or study of another crate needs besides: the versions that this crate uses.
pub use anyhow;
pub use clap;
pub use glam;
pub use image;
pub use serde;
