//! The structures themselves.

mod binary;
mod brute_force;
pub mod kd;
mod leaf;
mod line;
pub mod obvhs;
pub mod peers;
pub mod split;
mod walk;
pub mod wide;

pub use brute_force::{BruteForce, BruteForceConfig};
pub use kd::{KdConfig, KdTree};
pub use wide::{Partition, WideConfig, WideTree};
