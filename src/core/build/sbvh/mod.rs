//! Builds binary trees of tight boxes by spatial splits, by object splits, or by the cheaper one at each node.
//!
//! A reference is a triangle and the box of its part in a node. A *spatial* split cuts references at a plane, so the
//! boxes of both sides are disjoint. An *object* split divides whole references into two groups, whose boxes may
//! overlap. The surface area heuristic uses the tight boxes of both sides. A leaf costs one block test per eight
//! triangles, rounded up. With only spatial splits, the leaves partition space as in a KD-tree. If no plane can
//! divide a large leaf (coincident triangles, an exhausted budget), it becomes several leaves that may overlap.
//!
//! # References
//! Stich, Friedrich, Dietrich: Spatial Splits in Bounding Volume Hierarchies, High Performance Graphics 2009. Here, a
//! candidate plane lies at the highest box edge in its grid cell. Triangles in a plane go to the cheaper side. Overlap
//! costs extra. Each node has a budget of references, so the tree does not depend on the order of building.

mod config;
mod grow;
mod object;
mod offer;
mod spatial;
#[cfg(test)]
mod tests;

pub(crate) use config::{SbvhConfig, Splits};
pub(crate) use grow::build;
