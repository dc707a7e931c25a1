//! **sahara** (SAH And Ray Acceleration): benchmark, validate and image-test ray-tracing acceleration structures.

pub mod accel;
pub mod geometry;
pub mod golden;
pub mod oracle;
pub mod registry;
pub mod render;
pub mod scene;
pub mod simd;
pub mod structures;
pub mod triangle;
pub mod validate;
