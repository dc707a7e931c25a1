//! Builds a binary tree of tight boxes from the cells of a KD-tree.

use super::binned::Binned;
use super::config::CellConfig;
use super::grow::{Context, Rules, Tree, grow};
use crate::build::binary_tree::{BinaryNode, BinaryTree, Content};
use crate::build::cut::Cut;
use crate::build::part::{Part, halves};
use crate::geometry::{Aabb, Mesh};

/// Maximum number of references in a leaf. A cell with more references becomes several leaves.
const MOST: usize = 64;

/// `duplication` limits the mean number of references per triangle.
pub(crate) fn build(mesh: &Mesh, config: &CellConfig, duplication: f32) -> BinaryTree {
    let context = Context::new(mesh, Rules::sah(duplication), config);
    grow(&context, Binned::all(&context))
}

impl BinaryTree {
    fn push_leaves(&mut self, part: Part) {
        let (first, count) = (self.references.len() as u32, part.references.len());
        if count > MOST {
            let inner = self.nodes.len();
            self.push(Aabb::EMPTY, Content::Inner([0; 2]));
            let [below, above] = halves(part.references);
            self.push_leaves(below);
            let second = self.nodes.len();
            self.push_leaves(above);
            self.join(inner, second);
        } else {
            self.references.extend(part.references.iter().map(|r| r.id()));
            self.push(part.extent.into(), Content::Leaf { first, count: count as u32 });
        }
    }

    fn push(&mut self, bounds: Aabb, content: Content) {
        self.nodes.push(BinaryNode { bounds, content });
    }

    /// Makes the nodes `inner + 1` and `second` the children of `inner`.
    fn join(&mut self, inner: usize, second: usize) {
        let nodes = &mut self.nodes;
        let bounds = nodes[inner + 1].bounds.union(nodes[second].bounds);
        nodes[inner] = BinaryNode { bounds, content: Content::Inner([inner as u32 + 1, second as u32]) };
    }
}

/// A leaf stores a tight box around its clipped triangles.
impl Tree<Binned> for BinaryTree {
    const SKIPS_EMPTY: bool = true;

    fn len(&self) -> usize {
        self.nodes.len()
    }

    fn leaf(&mut self, content: Binned) {
        self.push_leaves(content.into_part());
    }

    fn open(&mut self) {
        self.push(Aabb::EMPTY, Content::Inner([0; 2]));
    }

    fn close(&mut self, inner: usize, _: Cut, second: usize) {
        self.join(inner, second);
    }

    fn append(&mut self, other: Self) {
        BinaryTree::append(self, other);
    }
}
