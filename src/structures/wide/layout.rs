//! Writes nodes and leaf blocks, depth first.

use super::collapse::{Collapse, Part};
use super::node::{Child, Node, WIDTH};
use crate::geometry::Mesh;
use crate::structures::leaf::LeafBlock;
use crate::triangle::TriangleTest;

pub(super) struct Layout<'a, T: TriangleTest> {
    mesh: &'a Mesh,
    collapse: &'a Collapse<'a>,
    pub nodes: Vec<Node>,
    pub blocks: Vec<LeafBlock<T, WIDTH>>,
    ids: Vec<u32>,
}

impl<'a, T: TriangleTest> Layout<'a, T> {
    pub fn new(mesh: &'a Mesh, collapse: &'a Collapse<'a>) -> Self {
        Self { mesh, collapse, nodes: vec![], blocks: vec![], ids: vec![] }
    }

    pub fn write(&mut self, part: Part) -> Child {
        let at = match part {
            Part::Node(at) => at,
            Part::Leaf(at) => {
                let mut ids = std::mem::take(&mut self.ids);
                self.collapse.ids(at, &mut ids);
                let first = self.blocks.len();
                LeafBlock::fill(self.mesh, &ids, &mut self.blocks);
                self.ids = ids;
                return Child::leaf(first, self.blocks.len() - first);
            }
        };
        let own = self.nodes.len();
        self.nodes.push(Node::EMPTY);
        let mut parts = Vec::with_capacity(WIDTH);
        let orders = self.collapse.children(at, &mut parts);
        let mut node = Node { orders, ..Node::EMPTY };
        for (lane, &part) in parts.iter().enumerate() {
            let (Part::Node(at) | Part::Leaf(at)) = part;
            node.set(lane, &self.collapse.node(at).bounds, self.write(part));
        }
        self.nodes[own] = node;
        Child::node(own)
    }
}
