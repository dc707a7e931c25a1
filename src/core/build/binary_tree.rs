//! The binary tree that is collapsed into an eight-wide tree.

use crate::geometry::Aabb;

/// Nodes are in depth-first order: a node, the subtree of its first child, the subtree of its second child. A subtree
/// is therefore a range of nodes and a range of references. A tree without triangles has no nodes.
#[derive(Clone, Debug, Default)]
pub(crate) struct BinaryTree {
    pub nodes: Vec<BinaryNode>,
    /// Triangle numbers, in the order of the leaves.
    pub references: Vec<u32>,
}

#[derive(Clone, Copy, Debug)]
pub(crate) struct BinaryNode {
    /// A box around the node's triangles or their clipped parts, rounded outward. The box is not empty in a finished
    /// tree.
    pub bounds: Aabb,
    pub content: Content,
}

#[derive(Clone, Copy, Debug)]
pub(crate) enum Content {
    Inner([u32; 2]),
    /// A nonempty range of references.
    Leaf {
        first: u32,
        count: u32,
    },
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
