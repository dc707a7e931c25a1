//! Meshes, triangle tests and ray-tracing acceleration structures for renderers.
//!
//! This example builds a structure over a mesh and traces two rays:
//!
//! ```
//! use std::sync::Arc;
//!
//! use sahara_core::accel::Accel;
//! use sahara_core::bvh8::{Bvh8, Bvh8Config, Partition};
//! use sahara_core::geometry::{Hit, Mesh, Ray};
//! use sahara_core::glam::Vec3;
//! use sahara_core::triangle::Exact;
//!
//! let triangles: Vec<[Vec3; 3]> = vec![[Vec3::X, Vec3::Y, Vec3::Z], [Vec3::X, Vec3::Y, -Vec3::Z]];
//! let mesh = Arc::new(Mesh::from_triangles(&triangles)?);
//! // The structure `sah-hybrid` of the command, over its default triangle test.
//! let tree = Bvh8::<Exact>::build(&mesh, &Bvh8Config::new(Partition::Hybrid))?;
//!
//! let rays = [Ray::new(Vec3::ZERO, Vec3::new(1.0, 1.0, -2.0)), Ray::new(Vec3::ZERO, -Vec3::X)];
//! let (mut hits, mut occluded) = ([None; 2], [false; 2]);
//! tree.closest_hits(&rays, &mut hits, &mut ());
//! tree.any_hits(&rays, &mut occluded, &mut ());
//! assert_eq!((hits, occluded), ([Some(Hit::new(0.25, 1)), None], [true, false]));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! Generic structures such as `Bvh8` are compiled with the optimization level of your crate.

#![warn(missing_docs)]

pub mod accel;
/// Brute force over all triangles.
pub mod brute_force;
pub mod build;
pub mod bvh8;
pub mod exact;
#[cfg(feature = "suite")]
pub mod external;
pub mod geometry;
pub mod kdtree;
#[cfg(feature = "suite")]
pub mod offered;
#[cfg(feature = "suite")]
pub mod oracle;
pub mod simd;
mod traversal;
pub mod triangle;

// The API uses types of these crates. The re-exports give users the matching versions.
pub use glam;
pub use serde;
