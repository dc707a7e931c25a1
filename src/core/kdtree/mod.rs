//! KD-trees. `median-kd`, the tree of the student report that sahara reproduces ("the report" below), and the SAH tree
//! `sah-kd` are two configurations of one type.

mod config;
mod median;
mod node;
#[cfg(test)]
mod tests;
mod traverse;
mod tree;

pub use config::{AxisRule, CountOf, Equal, Exit, KdConfig, Limit, Median, Plane, Stop, Traversal};
pub use tree::KdTree;
