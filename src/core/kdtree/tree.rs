use std::sync::Arc;

use super::config::{KdConfig, Plane};
use super::median::Triangles;
use super::node::{Limits, Node};
use crate::accel::{Accel, BuildError, Footprint, Part, TreeShape};
use crate::build::cells::{Binned, Content, Context, Tree, grow};
use crate::build::cut::Cut;
use crate::geometry::{Aabb, Mesh};
use crate::traversal::leaf::LeafBlock;
use crate::traversal::pages;
use crate::traversal::walk::walked_queries;
use crate::triangle::{BLOCK, TriangleTest};

/// A kd-tree with 8-byte nodes in depth-first order.
///
/// The tree does not depend on the number of threads.
///
/// # References
/// Wald, Havran: On building fast kd-trees for ray tracing, and on doing that in O(N log N), 2006. Havran: Heuristic
/// Ray Shooting Algorithms, 2000.
pub struct KdTree<T: TriangleTest> {
    pub(super) nodes: Vec<Node>,
    pub(super) blocks: Vec<LeafBlock<T>>,
    pub(super) bounds: Aabb,
    pub(super) config: KdConfig,
}

impl<T: TriangleTest> KdTree<T> {
    #[inline(always)]
    pub(super) fn blocks_of(&self, leaf: Node) -> &[LeafBlock<T>] {
        let first = leaf.first() as usize;
        &self.blocks[first..first + (leaf.references() as usize).div_ceil(BLOCK)]
    }
}

impl<T: TriangleTest> Accel for KdTree<T> {
    type Config = KdConfig;

    const TRIANGLE_TEST: &'static str = T::NAME;

    fn build(mesh: &Arc<Mesh>, config: &KdConfig) -> Result<Self, BuildError> {
        let Plan { mut nodes, references } = plan(mesh, config, &Limits::OF_NODES)?;
        let leaves = nodes.iter().filter(|node| node.is_leaf());
        let count = leaves.map(|leaf| (leaf.references() as usize).div_ceil(BLOCK)).sum();
        let mut blocks = pages::with_capacity(count);
        for node in nodes.iter_mut().filter(|node| node.is_leaf()) {
            let (first, count) = (node.first() as usize, node.references());
            *node = Node::leaf(blocks.len() as u32, count);
            LeafBlock::fill(mesh, &references[first..first + count as usize], &mut blocks);
        }
        Ok(Self { nodes: pages::moved(nodes), blocks, bounds: mesh.bounds(), config: *config })
    }

    walked_queries!();

    fn footprint(&self) -> Footprint {
        let nodes = size_of_val(&self.nodes[..]);
        Footprint { nodes, other: size_of::<Self>(), ..LeafBlock::footprint(&self.blocks) }
    }

    fn shape(&self) -> TreeShape {
        TreeShape::of(Some((0, self.bounds)), |at, cell| {
            let node: Node = self.nodes[at];
            if node.is_leaf() {
                return Part::Leaf(node.references() as usize);
            }
            let (below, above) = cell.cut(node.axis(), node.split());
            Part::Inner(vec![(at + 1, below), (node.above() as usize, above)])
        })
    }
}

/// A tree whose leaves refer to `references` instead of blocks.
#[derive(Default)]
pub(super) struct Plan {
    pub nodes: Vec<Node>,
    pub references: Vec<u32>,
}

pub(super) fn plan(mesh: &Mesh, config: &KdConfig, limits: &Limits) -> Result<Plan, BuildError> {
    config.check()?;
    // Every triangle with an area has at least one reference.
    limits.check(1, mesh.solid().count())?;
    let rules = config.rules();
    let plan: Plan = match config.plane {
        Plane::VertexMedian | Plane::SpatialMedian | Plane::CentroidMedian => {
            let context = Context::new(mesh, rules, config);
            grow(&context, Triangles::all(&context))
        }
        Plane::SahBinned | Plane::SahSweep => {
            let sah = config.sah();
            let context = Context::new(mesh, rules, &sah);
            grow(&context, Binned::all(&context))
        }
    };
    // No index or count in a node exceeds these totals.
    limits.check(plan.nodes.len(), plan.references.len())?;
    Ok(plan)
}

impl<C: Content> Tree<C> for Plan {
    const SKIPS_EMPTY: bool = false;

    fn len(&self) -> usize {
        self.nodes.len()
    }

    fn leaf(&mut self, content: C) {
        self.nodes.push(Node::leaf(self.references.len() as u32, content.len() as u32));
        self.references.extend(content.ids());
    }

    fn open(&mut self) {
        // `close` replaces this placeholder.
        self.nodes.push(Node::leaf(0, 0));
    }

    fn close(&mut self, inner: usize, cut: Cut, second: usize) {
        self.nodes[inner] = Node::inner(cut.axis, cut.plane, second as u32);
    }

    fn append(&mut self, other: Self) {
        let (nodes, references) = (self.nodes.len() as u32, self.references.len() as u32);
        self.nodes.extend(other.nodes.into_iter().map(|node| {
            if node.is_leaf() {
                Node::leaf(node.first() + references, node.references())
            } else {
                Node::inner(node.axis(), node.split(), node.above() + nodes)
            }
        }));
        self.references.extend(other.references);
    }
}
