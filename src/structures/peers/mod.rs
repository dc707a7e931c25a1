//! Structures of other projects, each behind a feature of its own (`peer-*`, or `peers` for all), adapted without handicap.
//!
//! - **Rays** are converted one by one inside of the timed region, as those of obvhs and ours are prepared there: what a
//!   structure needs of a ray beyond origin, direction and interval is part of its cost, for all alike. Every adapter fills its
//!   peer's ray on the stack and nothing else: some 5 ns a ray for Embree's 96 bytes, as much for a unit direction and its
//!   inverse, where a ray of the hard scenes takes 60 ns and more.
//! - **Triangle tests**: the peer's own, wrapped as a test of ours where its API hands it out alone, so that brute force over
//!   it can be the reference; and ours where the peer takes a closure.
//! - **Triangles without area** are left out, as for all structures; an empty scene is answered without asking the peer.
//! - **Conventions** that differ from the contract are declared ([`Accel::CONVENTIONS`](crate::accel::Accel::CONVENTIONS)),
//!   shown by `sahara list` and told apart from errors.

#[cfg(feature = "peer-bvh")]
pub mod bvh;
#[cfg(feature = "peer-embree")]
pub mod embree;
#[cfg(feature = "peer-kdtree-ray")]
pub mod kdtree_ray;
#[cfg(any(feature = "peer-bvh", feature = "peer-parry", feature = "peer-kdtree-ray"))]
mod leaves;
#[cfg(feature = "peer-parry")]
pub mod parry;
#[cfg(feature = "peer-tinybvh")]
pub mod tinybvh;
