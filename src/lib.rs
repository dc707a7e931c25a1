//! **sahara** (SAH And Ray Acceleration): benchmark, validate and image-test ray-tracing acceleration structures.

pub mod geometry;
pub mod scene;
