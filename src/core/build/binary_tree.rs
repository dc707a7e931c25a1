//! The binary tree of tight boxes: every partition builds one, and collapsing it gives a wide tree.

use crate::geometry::Aabb;

/// Leaves of a partition and the splits above them, depth first: a node, then the subtree of its first child, then the
/// subtree of its second child. So the subtree of a node is a range of nodes and a range of references. A tree without
/// triangles has no nodes.
#[derive(Clone, Debug, Default)]
pub(crate) struct BinaryTree {
    pub nodes: Vec<BinaryNode>,
    /// The triangles of all leaves, one leaf after the other.
    pub references: Vec<u32>,
}

#[derive(Clone, Copy, Debug)]
pub(crate) struct BinaryNode {
    /// The box of the node's triangles, clipped to its part of space if they were split; rounded outward, never empty.
    pub bounds: Aabb,
    pub content: Content,
}

#[derive(Clone, Copy, Debug)]
pub(crate) enum Content {
    /// The numbers of the two children.
    Inner([u32; 2]),
    /// A range of references, not empty.
    Leaf { first: u32, count: u32 },
}

impl BinaryTree {
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
