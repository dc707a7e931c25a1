//! The shape of a tree.

use crate::geometry::Aabb;

/// Counts of a finished tree. A structure without a tree counts as one leaf.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TreeShape {
    /// Nodes with children.
    pub inner: usize,
    /// Leaves, including empty leaves.
    pub leaves: usize,
    /// Empty leaves.
    pub empty: usize,
    /// Pairs of a leaf and a triangle in the leaf.
    pub references: usize,
    /// Edges from the root to the deepest leaf.
    pub depth: usize,
    /// References in the largest leaf.
    pub largest_leaf: usize,
    /// Expected cost of a random line through the root box, in triangle tests (MacDonald, Booth 1990). An inner node
    /// costs [`TreeShape::INNER_COST`]. A triangle of a leaf costs 1. `None` if the tree is unknown. `None` if the area
    /// of the root box is zero or not finite.
    pub sah_cost: Option<f64>,
}

/// A node of a tree.
pub enum Part<N> {
    /// A leaf with the given count of references.
    Leaf(usize),
    /// An inner node with the given children. Each child has a bounding box.
    Inner(Vec<(N, Aabb)>),
}

impl TreeShape {
    /// Cost of an inner node, relative to one triangle test (Aila, Karras, Laine 2013).
    pub const INNER_COST: f64 = 1.2;

    /// The shape of a single leaf with an unknown cost.
    pub fn one_leaf(references: usize) -> Self {
        let empty = usize::from(references == 0);
        Self { leaves: 1, empty, references, largest_leaf: references, ..Self::default() }
    }

    /// Counts the nodes of a tree. `open` converts a node to a [`Part`]. If `root` is `None`, all counts are 0.
    pub fn of<N>(root: Option<(N, Aabb)>, mut open: impl FnMut(N, &Aabb) -> Part<N>) -> Self {
        let root_area = root.as_ref().map_or(0.0, |(_, bounds)| bounds.half_area());
        let mut shape = Self::default();
        let mut cost = 0.0;
        let mut waiting: Vec<(N, Aabb, usize)> = root.into_iter().map(|(at, bounds)| (at, bounds, 0)).collect();
        while let Some((at, bounds, depth)) = waiting.pop() {
            match open(at, &bounds) {
                Part::Leaf(references) => {
                    cost += bounds.half_area() * references as f64;
                    shape.leaves += 1;
                    shape.empty += usize::from(references == 0);
                    shape.references += references;
                    shape.largest_leaf = shape.largest_leaf.max(references);
                    shape.depth = shape.depth.max(depth);
                }
                Part::Inner(children) => {
                    cost += bounds.half_area() * Self::INNER_COST;
                    shape.inner += 1;
                    waiting.extend(children.into_iter().rev().map(|(at, bounds)| (at, bounds, depth + 1)));
                }
            }
        }
        shape.sah_cost = (root_area > 0.0 && root_area.is_finite()).then(|| cost / root_area);
        shape
    }
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::*;

    #[test]
    fn nodes_are_counted_and_weighted_by_area() {
        let unit = Aabb { min: Vec3::ZERO, max: Vec3::ONE };
        let halved = |bounds: &Aabb, children: [u32; 2]| {
            let (low, high) = bounds.cut(0, bounds.centre().x);
            Part::Inner(children.into_iter().zip([low, high]).collect())
        };
        let shape = TreeShape::of(Some((0, unit)), |node, bounds| match node {
            0 => halved(bounds, [1, 2]),
            1 => halved(bounds, [3, 4]),
            2 => Part::Leaf(3),
            3 => Part::Leaf(2),
            _ => Part::Leaf(0),
        });
        assert_eq!((shape.inner, shape.leaves, shape.empty, shape.references), (2, 3, 1, 5));
        assert_eq!((shape.depth, shape.largest_leaf), (2, 3));
        // The half areas are 3, 2 and 1.5. The cost is (1.2 * 3 + 1.2 * 2 + 2 * 1.5 + 3 * 2) / 3.
        assert!((shape.sah_cost.unwrap() - 5.0).abs() < 1e-12, "{shape:?}");
        assert_eq!(TreeShape::of(None::<((), Aabb)>, |_, _| Part::Leaf(0)), TreeShape::default());
        assert_eq!(TreeShape::of(Some(((), unit)), |(), _| Part::Leaf(1)).sah_cost, Some(1.0));
    }
}
