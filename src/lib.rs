//! **sahara** (SAH And Ray Acceleration): benchmark, validate and image-test ray-tracing acceleration structures.
//!
//! The command is described in the README. This page is for those who bring something of their own.
#![doc = ""]
#![doc = include_str!("WALK_THROUGH_1_STRUCTURE.md")]
#![doc = "```"]
#![doc = include_str!("../tests/third_party/grid.rs")]
#![doc = "```"]
#![doc = include_str!("WALK_THROUGH_2_COMMAND_AND_TESTS.md")]

pub mod accel;
pub mod cli;
pub mod exact;
pub mod fetch;
pub mod geometry;
pub mod golden;
pub mod measure;
mod nearest;
pub mod oracle;
pub mod output;
pub mod publish;
pub mod registry;
pub mod render;
pub mod report;
pub mod scene;
pub mod simd;
pub mod structures;
pub mod study;
pub mod triangle;
pub mod validate;

// What a structure of another crate needs besides: the versions that this crate uses.
pub use glam;
pub use serde;
