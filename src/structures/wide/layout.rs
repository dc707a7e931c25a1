//! Writes nodes and leaf blocks, depth first.

use super::collapse::{Collapse, Part};
use super::node::{Child, Node, WIDTH};
use crate::geometry::Mesh;
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
                self.leaf(&ids)
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

    fn leaf(&mut self, ids: &[u32]) -> Child {
        let (first, blocks) = (self.blocks.len(), ids.len().div_ceil(WIDTH));
        assert!(blocks <= Child::BLOCKS, "every partition deals out what is more than a leaf takes");
        LeafBlock::fill(self.mesh, ids, &mut self.blocks);
        Child::leaf(first, blocks)
    }

    fn begin(&mut self, depth: usize) -> usize {
        self.depth = self.depth.max(depth + 1);
        self.nodes.push(Node::EMPTY);
        self.nodes.len() - 1
    }
}
