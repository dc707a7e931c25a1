//! Divides space into the cells of a KD-tree. The surface area heuristic or a rule of the caller chooses the planes.

mod binned;
mod config;
mod grow;
mod sweep;
#[cfg(test)]
mod tests;
mod tight;

pub(crate) use binned::Binned;
pub(crate) use config::CellConfig;
pub(crate) use grow::{Content, Context, DEEPEST, NodeState, Rules, Tree, grow};
pub(crate) use tight::build;
