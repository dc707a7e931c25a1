//! **sahara** (SAH And Ray Acceleration): benchmark, validate and image-test ray-tracing acceleration structures.
//!
//! The command is described in the README. This page is for those who use the trees in a renderer, or bring a structure of
//! their own.
//!
//! # The trees in a renderer
//!
//! With `default-features = false` the crate is its core: meshes, triangle tests and the structures, on five small libraries.
//! A structure is built over a mesh and answers slices of rays:
//!
//! ```
//! use std::sync::Arc;
//!
//! use sahara::accel::Accel;
//! use sahara::bvh8::{Bvh8, Bvh8Config, Partition};
//! use sahara::geometry::{Hit, Mesh, Ray};
//! use sahara::glam::Vec3;
//! use sahara::triangle::Exact;
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
#![cfg_attr(feature = "suite", doc = include_str!("WALK_THROUGH_1_STRUCTURE.md"))]
#![cfg_attr(feature = "suite", doc = "```")]
#![cfg_attr(feature = "suite", doc = include_str!("../tests/third_party/grid.rs"))]
#![cfg_attr(feature = "suite", doc = "```")]
#![cfg_attr(feature = "suite", doc = include_str!("WALK_THROUGH_2_COMMAND_AND_TESTS.md"))]

// The core.
pub mod accel;
pub mod brute_force;
pub mod build;
pub mod bvh8;
pub mod exact;
pub mod geometry;
pub mod kdtree;
pub mod simd;
mod traversal;
pub mod triangle;

// The suite.
#[cfg(feature = "suite")]
pub mod cli;
#[cfg(feature = "suite")]
pub mod external;
#[cfg(feature = "suite")]
pub mod fetch;
#[cfg(feature = "suite")]
pub mod golden;
#[cfg(feature = "suite")]
pub mod measure;
#[cfg(feature = "suite")]
mod names;
#[cfg(feature = "suite")]
pub mod oracle;
#[cfg(feature = "suite")]
pub mod output;
#[cfg(feature = "suite")]
pub mod page;
#[cfg(feature = "suite")]
pub mod registry;
#[cfg(feature = "suite")]
pub mod render;
#[cfg(feature = "suite")]
pub mod report;
#[cfg(feature = "suite")]
pub mod runner;
#[cfg(feature = "suite")]
pub mod scene;
#[cfg(feature = "suite")]
pub mod study;
#[cfg(feature = "suite")]
pub mod validate;

// What a structure or study of another crate needs besides: the versions that this crate uses.
#[cfg(feature = "suite")]
pub use anyhow;
#[cfg(feature = "suite")]
pub use clap;
pub use glam;
pub use serde;
