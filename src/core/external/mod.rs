//! Structures of other projects: the baseline `obvhs` and the peers.
//!
//! Each peer has a Cargo feature, for example `peer-bvh`. The Cargo feature `peers` of the crate `sahara` adds all
//! peers.
//!
//! - [`Accel::load`](crate::accel::Accel::load) converts rays to the format of a peer.
//! - [`Accel::CONVENTIONS`](crate::accel::Accel::CONVENTIONS) lists intended differences from the contract of `Accel`.
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
