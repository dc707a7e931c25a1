//! What a tree looks like.

use super::Histogram;

/// Counts of a finished tree. A structure without a tree is one leaf.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TreeShape {
    /// Nodes with children.
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
    /// Expected cost of a random line through the root box, in triangle tests (MacDonald, Booth 1990), with the same
    /// constants for every structure: [`TreeShape::INNER_COST`] and [`TreeShape::leaf_cost`]. `None` where it is not
    /// defined.
    pub sah_cost: Option<f64>,
    /// Leaves by their number of references. Empty where it is not known.
    pub leaf_sizes: Histogram,
    /// Leaves by their depth. Empty where it is not known.
    pub leaf_depths: Histogram,
}

impl TreeShape {
    /// Cost of an inner node in triangle tests: the value of Aila, Karras, Laine (2013).
    pub const INNER_COST: f64 = 1.2;

    /// Cost of a leaf: one for each triangle.
    pub fn leaf_cost(references: usize) -> f64 {
        references as f64
    }
}
