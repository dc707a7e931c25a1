//! What every wide tree is collapsed from: a binary tree of tight boxes, whoever partitioned the triangles.

use crate::geometry::Aabb;

/// Leaves of a partition and how they were found, depth first: a node, then all below its first child, then all below its second.
/// So what is below a node is a range, of nodes and of references.
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
