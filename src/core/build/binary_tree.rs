//! The binary tree from which an eight-wide tree is collapsed.

use crate::geometry::Aabb;

/// The nodes in depth-first order: a node, then the subtree of its first child, then the subtree of its second child. A
/// subtree is therefore a range of nodes and a range of references. A tree without triangles has no nodes.
#[derive(Clone, Debug, Default)]
pub(crate) struct BinaryTree {
    pub nodes: Vec<BinaryNode>,
    /// The triangles of all leaves, one leaf after the other.
    pub references: Vec<u32>,
}

#[derive(Clone, Copy, Debug)]
pub(crate) struct BinaryNode {
    /// The bounds of the node's references, rounded outward; a cut triangle contributes only its part in the node. Not
    /// empty in a finished tree.
    pub bounds: Aabb,
    pub content: Content,
}

#[derive(Clone, Copy, Debug)]
pub(crate) enum Content {
    /// The indices of the two children.
    Inner([u32; 2]),
    /// A nonempty range of references.
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
