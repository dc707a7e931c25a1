//! Builds binary trees of tight boxes by spatial splits, object splits or both.
//!
//! A reference is a triangle and the box of the triangle's part in a node. A *spatial* split cuts references at a
//! plane, so the boxes of both sides are disjoint. An *object* split assigns each reference to one of two groups. The
//! boxes of the groups may overlap.
//!
//! # References
//! Stich, Friedrich, Dietrich: Spatial Splits in Bounding Volume Hierarchies, High Performance Graphics 2009.
//!
//! Differences from the paper:
//! - A candidate plane lies at the highest box edge in a grid cell.
//! - A triangle that lies in the split plane goes to the cheaper side.
//! - An object split whose boxes overlap has an extra cost.
//! - Each node has a separate budget of references.

mod config;
mod grow;
mod object;
mod offer;
mod spatial;
#[cfg(test)]
mod tests;

pub(crate) use config::{SbvhConfig, Splits};
pub(crate) use grow::build;
