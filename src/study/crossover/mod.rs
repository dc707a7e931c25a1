//! `crossover`: is there a depth complexity beyond which a KD-tree is faster than a BVH?
//!
//! A family of scenes of one to hundreds of layers of perforated sheets, of always the same number of triangles
//! ([`meshes::sheets`](crate::scene::meshes::sheets)), and pairs of a KD-tree and a BVH. Their ratio of times is set against the depth
//! complexity that is measured: the surfaces that a ray would meet if none stopped it.
//!
//! # References
//! Vinkler, Havran, Bittner: Performance comparison of bounding volume hierarchies and kd-trees for GPU ray tracing, 2016: on GPUs the
//! BVH is faster on simple and moderate scenes, the KD-tree on those of high depth complexity.

mod complexity;
mod curve;
mod family;
mod result;
mod table;
#[cfg(test)]
mod tests;

use serde::{Deserialize, Serialize};

use super::epoch::Epoch;

pub use complexity::complexity;
pub use curve::Crossing;
pub use family::{ROOTS, member};
pub use result::{Member, Race, Row, result, rows};
pub use table::tables;

/// Name of the study, and of its journal.
pub const NAME: &str = "crossover";

/// The KD-tree and the BVH of a pair. In the second and third the node, the leaf and the walk are the same and only the way to divide
/// the triangles differs; the first are the textbook tree and the BVH from outside. All over one triangle test.
pub const PAIRS: [[&str; 2]; 3] = [
    ["sah-kd:test=moller-trumbore", "obvhs-bvh2"],
    ["sah-kd-wide:test=moller-trumbore", "sah-bvh:test=moller-trumbore"],
    ["sah-kd-tight:test=moller-trumbore", "sah-bvh:test=moller-trumbore"],
];

/// One epoch of one member of the family.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Case {
    pub layers: u32,
    /// Of each kind of rays of the epoch's, by name.
    pub complexity: Vec<(String, f64)>,
    pub epoch: Epoch,
}
