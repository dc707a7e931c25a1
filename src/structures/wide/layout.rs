//! Writes nodes and leaf blocks, depth first.

use super::collapse::{Collapse, Part};
use super::node::{Child, Node, WIDTH};
use crate::geometry::{Aabb, Mesh};
use crate::structures::leaf::LeafBlock;
use crate::triangle::TriangleTest;

/// What a walk goes through.
pub(super) struct Layout<'a, T: TriangleTest> {
    mesh: &'a Mesh,
    collapse: &'a Collapse<'a>,
    pub nodes: Vec<Node>,
    pub blocks: Vec<LeafBlock<T, WIDTH>>,
    /// Nodes on the longest path from the root.
    pub depth: usize,
}

/// The order in which any octant visits children that are all in one place.
const ANY_ORDER: u32 = 0o01234567;

impl<'a, T: TriangleTest> Layout<'a, T> {
    pub fn new(mesh: &'a Mesh, collapse: &'a Collapse<'a>) -> Self {
        Self { mesh, collapse, nodes: vec![], blocks: vec![], depth: 0 }
    }

    /// Writes `part`, which is below `depth` nodes.
    pub fn write(&mut self, part: Part, depth: usize) -> Child {
        match part {
            Part::Leaf(at) => {
                let mut ids = vec![];
                self.collapse.ids(at, &mut ids);
                self.leaf(&ids, self.collapse.bounds(part), depth)
            }
            Part::Node(at) => {
                let own = self.begin(depth);
                let mut parts = Vec::with_capacity(WIDTH);
                let mut node = Node { orders: self.collapse.children(at, &mut parts), ..Node::EMPTY };
                for (lane, &part) in parts.iter().enumerate() {
                    node.set(lane, self.collapse.bounds(part), self.write(part, depth + 1));
                }
                self.nodes[own] = node;
                Child::node(own)
            }
        }
    }

    /// Writes a leaf; where it is larger than leaves can be, nodes over parts of it.
    fn leaf(&mut self, ids: &[u32], bounds: &Aabb, depth: usize) -> Child {
        let blocks = ids.len().div_ceil(WIDTH);
        if blocks <= Child::BLOCKS {
            let first = self.blocks.len();
            LeafBlock::fill(self.mesh, ids, &mut self.blocks);
            return Child::leaf(first, blocks);
        }
        let own = self.begin(depth);
        let mut node = Node { orders: [ANY_ORDER; 8], ..Node::EMPTY };
        for (lane, ids) in ids.chunks(blocks.div_ceil(WIDTH) * WIDTH).enumerate() {
            node.set(lane, bounds, self.leaf(ids, bounds, depth + 1));
        }
        self.nodes[own] = node;
        Child::node(own)
    }

    fn begin(&mut self, depth: usize) -> usize {
        self.depth = self.depth.max(depth + 1);
        self.nodes.push(Node::EMPTY);
        self.nodes.len() - 1
    }
}
