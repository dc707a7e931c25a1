//! The binary tree from which an eight-wide tree is collapsed.

use crate::geometry::Aabb;

/// Nodes are in depth-first order, with the subtree of the first child before the subtree of the second. A subtree is
/// therefore a range of nodes and a range of references. A tree without triangles has no nodes.
#[derive(Clone, Debug, Default)]
pub(crate) struct BinaryTree {
    pub nodes: Vec<BinaryNode>,
    /// The triangle numbers of all leaves, in the order of the leaves.
    pub references: Vec<u32>,
}

#[derive(Clone, Copy, Debug)]
pub(crate) struct BinaryNode {
    /// A box around the references of the node, rounded outward. A cut triangle contributes only its part in the node.
    /// The box is not empty in a finished tree.
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
