//! The binary tree of tight boxes, from which all wide trees are collapsed, for all partitions.

use crate::geometry::Aabb;

/// Leaves of a partition and the splits above them, depth first: a node, then all nodes below its first child, then all
/// below its second. So the subtree of a node is a range of nodes and a range of references.
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
    /// Contains the parts of the triangles inside this part of space, rounded outward; never empty.
    pub bounds: Aabb,
    pub content: Content,
}

/// The content of a part.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Content {
    /// Two nodes, by number.
    Inner([u32; 2]),
    /// A range of references, not empty.
    Leaf { first: u32, count: u32 },
}

impl BinaryTree {
    /// Appends the nodes of `other`.
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
