//! The structures themselves.

mod brute_force;
mod leaf;

pub use brute_force::{BruteForce, BruteForceConfig};
