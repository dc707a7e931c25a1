//! Code that the tree builders share.

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
