//! The structures themselves.

mod binary;
#[cfg(test)]
mod binary_check;
mod brute_force;
mod extent;
pub mod kd;
mod leaf;
mod line;
#[cfg(feature = "suite")]
pub mod obvhs;
#[cfg(feature = "suite")]
mod overlap;
mod pages;
#[cfg(feature = "suite")]
pub mod peers;
#[cfg(feature = "suite")]
mod prepared;
mod reinsert;
pub mod split;
mod walk;
pub mod wide;

pub use brute_force::{BruteForce, BruteForceConfig};
pub use kd::{KdConfig, KdTree};
#[cfg(feature = "suite")]
pub use overlap::end_point_overlap;
pub use wide::{Batch, Partition, WideConfig, WideTree};
