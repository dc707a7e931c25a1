//! Structures of other projects: the baseline `obvhs`, and the peers, each behind its own feature (`peer-*`, or `peers`
//! for all). The adapters do not handicap them.
//!
//! - **Rays** of a peer are converted before the clock starts ([`Accel::load`](crate::accel::Accel::load)): to the
//!   peer's ray type and to the input of the triangle test. The structures of this crate and obvhs prepare rays inside
//!   the timed region, so the comparison favours the peers.
//! - **Triangle tests**: a peer uses its own test and, if it accepts a closure, the tests of this crate. If its API
//!   exposes its own test, the adapter wraps it as a `TriangleTest`, so brute force over it can be the reference.
//! - **Triangles without area** are left out, as in all structures.
//! - **Conventions** that differ from the contract of `Accel` are declared
//!   ([`Accel::CONVENTIONS`](crate::accel::Accel::CONVENTIONS)); `sahara list` prints them, and they do not count as
//!   errors.
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
