//! KD-trees. `median-kd` is the tree of a student report. `sah-kd` is an SAH tree.

mod config;
mod median;
mod node;
#[cfg(test)]
mod tests;
mod traverse;
mod tree;

pub use config::{AxisRule, CountOf, Equal, Exit, KdConfig, Limit, Median, Plane, Stop, Traversal};
pub use tree::KdTree;
