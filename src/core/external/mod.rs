//! Structures of other projects: the baseline `obvhs` and the peers.
//!
//! Each peer has a feature `peer-*`; the feature `peers` adds all peers. The adapters do not handicap these structures.
//!
//! - **Rays** of a peer are converted before the clock starts ([`Accel::load`](crate::accel::Accel::load)). The
//!   structures of this crate and obvhs prepare rays inside the timed region.
//! - **Triangle tests**: a peer uses its own test. A peer that accepts a closure also uses the tests of this crate. If
//!   a peer exposes its own test, the adapter wraps this test as a `TriangleTest`, for brute force.
//! - **Triangles without area** are left out, as in all structures.
//! - **Conventions** that differ from the contract of `Accel` are declared
//!   ([`Accel::CONVENTIONS`](crate::accel::Accel::CONVENTIONS)) and do not count as errors.
//!
//! # Peers
#![doc = include_str!("PEERS.md")]

#[cfg(feature = "peer-bvh")]
pub mod bvh;
#[cfg(feature = "peer-embree")]
pub mod embree;
mod lanes;
#[cfg(any(feature = "peer-bvh", feature = "peer-parry"))]
mod leaves;
pub mod obvhs;
#[cfg(feature = "peer-parry")]
pub mod parry;
#[cfg(any(feature = "peer-bvh", feature = "peer-parry", feature = "peer-tinybvh"))]
mod prepared;
#[cfg(feature = "peer-tinybvh")]
pub mod tinybvh;
