//! Structures of other projects: the baseline `obvhs`, and the peers, each behind a feature of its own (`peer-*`, or
//! `peers` for all), adapted without handicap.
//!
//! - **Rays** are brought into the peer's form once, before the clock starts
//!   ([`Accel::load`](crate::accel::Accel::load)), its own ray with unit or inverse direction where it has one, and
//!   what the triangle test wants. Inside of the timed region remain what a library computes in its own walk, and a
//!   copy to the stack where it writes into the ray. Of rays that mostly miss, this saves a fifth of the time and more.
//!   The structures of this crate take a ray as it comes and prepare it inside: the handicap is ours.
//! - **Triangle tests**: the peer's own, wrapped as a test of ours where its API hands it out alone, so that brute
//!   force over it can be the reference; and ours where the peer takes a closure.
//! - **Triangles without area** are left out, as for all structures; an empty scene is answered without asking the
//!   peer.
//! - **Conventions** that differ from the contract are declared
//!   ([`Accel::CONVENTIONS`](crate::accel::Accel::CONVENTIONS)), shown by `sahara list` and told apart from errors.
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
mod prepared;
#[cfg(feature = "peer-tinybvh")]
pub mod tinybvh;
