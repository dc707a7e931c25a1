use glam::Vec3A;

use super::collapse::Collapse;
use super::config::{Batch, Bvh8Config};
use super::layout::{Layout, PIECE};
use super::node::{Child, Limits, Node};
use crate::accel::BuildError;
use crate::build::sah_cost::CostModel;
use crate::geometry::{Aabb, Mesh};
use crate::traversal::leaf::LeafBlock;
use crate::traversal::line::farthest;
use crate::triangle::TriangleTest;

/// A tree of nodes with eight tight boxes, and leaves of blocks of eight triangles.
///
/// The configuration selects the partition: by spatial splits (disjoint cells, with a tight box in each), by object
/// splits, or by both. Collapse, layout and traversal are the same for all partitions. If the duplication of references
/// is bounded, a build takes O(n log n) time and memory. The tree is the same for every number of threads and cannot be
/// updated. A node takes 256 bytes; a block over Möller-Trumbore takes 320 bytes.
///
/// `papers/TUNING.md` documents how the constants were chosen and which experiments were rejected.
///
/// # References
/// Wald, Benthin, Boulos: Getting rid of packets, 2008 (wide nodes for single rays). Ylitie, Karras, Laine: Efficient
/// incoherent ray traversal on GPUs through compressed wide BVHs, 2017 (the collapse). Stich, Friedrich, Dietrich:
/// Spatial splits in bounding volume hierarchies, 2009.
pub struct Bvh8<T: TriangleTest> {
    // The `unsafe` blocks of the traversals rely on these invariants, which `Layout` establishes; a tree is never
    // changed. The root and all children of nodes name nodes in `nodes` or ranges of `blocks`. The root is a leaf only
    // if there are no triangles. Each node is the child of at most one other node. No path from the root has more than
    // `DEPTH` nodes, because `Limits::check` rejects longer paths.
    pub(super) root: Child,
    pub(super) nodes: Vec<Node>,
    pub(super) blocks: Vec<LeafBlock<T>>,
    pub(super) bounds: Aabb,
    /// The largest magnitude of a coordinate of `bounds` on each axis.
    pub(super) farthest: Vec3A,
    pub(super) batch: Batch,
    /// Whether closest-hit queries with [`Batch::Packets`] interleave the rays that form no packet.
    pub(super) interleaves: bool,
}

/// The size in bytes of the second-level cache of many processors. A smaller tree has few cache misses to hide.
const CACHE: usize = 2 << 20;

impl<T: TriangleTest> Bvh8<T> {
    pub(super) fn within(mesh: &Mesh, config: &Bvh8Config, limits: &Limits) -> Result<Self, BuildError> {
        config.check::<T>()?;
        limits.admit(mesh.solid().count(), config.duplication)?;
        let tree = config.partition(mesh);
        let collapse = Collapse::new(&tree, &CostModel::new(1.0, config.block_cost, 0.0));
        let Layout { root, nodes, blocks } = Layout::new(mesh, &collapse, limits, PIECE)?;
        let (bounds, batch) = (mesh.bounds(), config.batch);
        let interleaves = size_of_val(&nodes[..]) + size_of_val(&blocks[..]) > CACHE;
        Ok(Self { root, nodes, blocks, bounds, farthest: farthest(&bounds), batch, interleaves })
    }
}
