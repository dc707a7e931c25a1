//! Binary trees of tight boxes by one builder: splits of space, splits of the set of triangles, or the cheaper of both.
//!
//! Every reference is a triangle and the box of its part at this place of the tree. A *spatial* split cuts references
//! at a plane: both sides are disjoint. An *object* split divides whole references into two groups, whose boxes may
//! overlap. The surface area heuristic uses the tight boxes of both sides, and counts leaves by blocks of eight
//! triangles. With only spatial splits the leaves partition space as in a KD-tree, except that a leaf too full to be
//! cut in space (coincident triangles, an exhausted budget) is divided among several.
//!
//! # References
//! Stich, Friedrich, Dietrich: Spatial Splits in Bounding Volume Hierarchies, High Performance Graphics 2009. Three
//! departures from the paper: candidate planes are moved to the nearest edge of a box; triangles in a plane go to the
//! cheaper side; and a budget of references is passed down, which makes the tree independent of the order of building.

mod config;
mod grow;
mod object;
mod offer;
mod spatial;
#[cfg(test)]
mod tests;

pub(crate) use config::{SbvhConfig, Splits};
pub(crate) use grow::build;
