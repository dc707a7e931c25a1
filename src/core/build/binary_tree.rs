//! The binary tree of tight boxes that every wide tree is collapsed from, for all partitions.

use crate::geometry::Aabb;

/// Leaves of a partition and how they were found, depth first: a node, then all below its first child, then all below
/// its second. So what is below a node is a range, of nodes and of references.
///
/// Without triangles there are no nodes.
#[derive(Clone, Debug, Default)]
pub(crate) struct BinaryTree {
    pub nodes: Vec<BinaryNode>,
    /// The triangles of all leaves, one leaf after the other.
    pub references: Vec<u32>,
}

/// A part of the scene.
#[derive(Clone, Copy, Debug)]
pub(crate) struct BinaryNode {
    /// Holds what the triangles of this part have inside of it, rounded outward; never empty.
    pub bounds: Aabb,
    pub content: Content,
}

/// What a part is made of.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Content {
    /// Two nodes, by number.
    Inner([u32; 2]),
    /// A range of references, not empty.
    Leaf { first: u32, count: u32 },
}

impl BinaryTree {
    /// Adds the nodes of `other` behind these.
    pub fn append(&mut self, other: Self) {
        let (nodes, references) = (self.nodes.len() as u32, self.references.len() as u32);
        self.nodes.extend(other.nodes.into_iter().map(|node| {
            let content = match node.content {
                Content::Inner(children) => Content::Inner(children.map(|child| child + nodes)),
                Content::Leaf { first, count } => Content::Leaf { first: first + references, count },
            };
            BinaryNode { content, ..node }
        }));
        self.references.extend(other.references);
    }
}
