//! What a tree looks like.

/// Counts of a finished tree. A structure without a tree is one leaf.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TreeShape {
    pub inner: usize,
    /// Leaves, empty ones included.
    pub leaves: usize,
    /// Leaves that hold nothing.
    pub empty: usize,
    /// (leaf, primitive) pairs; at least the number of primitives that are not degenerate.
    pub references: usize,
    /// Edges from the root to the deepest leaf.
    pub depth: usize,
    /// References in the fullest leaf.
    pub largest_leaf: usize,
    /// Expected cost of a random line through the root box (MacDonald, Booth 1990), in units of one triangle test and
    /// with the structure's own traversal cost; `None` where it is not defined.
    pub sah_cost: Option<f64>,
}
