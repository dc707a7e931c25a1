//! The common parts of builders: references and their clipping, the cost model of the surface area heuristic, planes
//! and groups of triangles that may split a node, searches for the cheapest of them, reinsertion of subtrees of a
//! finished tree, and the resulting binary tree.

mod axes;
pub(crate) mod binary_tree;
pub(crate) mod cells;
#[cfg(test)]
pub(crate) mod check;
pub(crate) mod clip;
pub(crate) mod cut;
pub(crate) mod extent;
mod grouping;
mod part;
mod planes;
mod quality;
mod reference;
pub(crate) mod reinsert;
pub(crate) mod sah_cost;
mod sample;
pub(crate) mod sbvh;
mod slices;

pub use quality::Quality;
