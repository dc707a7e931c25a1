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

/// A bounding volume hierarchy with up to eight children per node. Leaves store triangles in blocks of eight.
///
/// The configuration selects spatial splits, object splits, or both. The tree does not depend on the number of threads.
/// `papers/TUNING.md` documents how the constants were chosen and which experiments were rejected.
///
/// # References
/// Wald, Benthin, Boulos: Getting rid of packets, 2008 (wide nodes for single rays). Ylitie, Karras, Laine: Efficient
/// incoherent ray traversal on GPUs through compressed wide BVHs, 2017 (the collapse). Stich, Friedrich, Dietrich:
/// Spatial splits in bounding volume hierarchies, 2009.
pub struct Bvh8<T: TriangleTest> {
    // The `unsafe` blocks of the traversals rely on these invariants. `Layout` establishes the invariants. No code
    // changes `root`, `nodes` or `blocks` after the build.
    // - The root and every child refer to a node in `nodes` or to a range of `blocks`.
    // - The root is a leaf only if the tree has no triangles.
    // - Each node is a child of at most one node.
    // - No path from the root has more than `DEPTH` nodes (see `Limits::check`).
    pub(super) root: Child,
    pub(super) nodes: Vec<Node>,
    pub(super) blocks: Vec<LeafBlock<T>>,
    pub(super) bounds: Aabb,
    /// For each axis, the largest magnitude of a coordinate in `bounds`.
    pub(super) farthest: Vec3A,
    pub(super) batch: Batch,
    /// Whether closest-hit queries with [`Batch::Packets`] interleave the rays that form no packet.
    pub(super) interleaves: bool,
}

/// A typical size of a second-level cache, in bytes. A tree that fits into the cache causes few cache misses.
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
