//! A tree as boxes and triangles: what it is, without how it is stored.

use super::TreeShape;
use crate::geometry::Aabb;

/// A finished tree as plain data, for measures of its shape: nodes in depth-first order, every node before its
/// children.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Outline {
    /// Every node before its children.
    pub nodes: Vec<OutlineNode>,
    /// Triangles of the mesh, leaf by leaf in the order of the nodes: those below a node stand in a row.
    pub references: Vec<u32>,
    /// Whether nodes are cells of space that share no inside, so that no surface is inside of a node and not below it.
    pub disjoint: bool,
}

/// A node or a leaf.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OutlineNode {
    /// What lies below it lies inside.
    pub bounds: Aabb,
    /// Edges from the root.
    pub depth: usize,
    /// Whether it is a leaf.
    pub leaf: bool,
    /// The first of the references below it.
    pub first: usize,
    /// The end of them.
    pub last: usize,
    /// The number of the node after everything below it.
    pub end: usize,
}

/// What is at a place of a tree.
pub enum Part<N> {
    /// A leaf; its triangles have been handed over.
    Leaf,
    /// An inner node: its children.
    Inner(Vec<(N, Aabb)>),
}

impl Outline {
    /// Walks a tree from `root`, if there is one. `open` returns what is at a place, and appends the triangles of a
    /// leaf.
    pub fn of<N>(root: Option<(N, Aabb)>, mut open: impl FnMut(N, &Aabb, &mut Vec<u32>) -> Part<N>) -> Self {
        let mut outline = Self::default();
        let mut waiting: Vec<(N, Aabb, usize)> = root.into_iter().map(|(at, bounds)| (at, bounds, 0)).collect();
        while let Some((at, bounds, depth)) = waiting.pop() {
            let first = outline.references.len();
            let part = open(at, &bounds, &mut outline.references);
            let leaf = matches!(part, Part::Leaf);
            outline.nodes.push(OutlineNode { bounds, depth, leaf, first, last: first, end: 0 });
            if let Part::Inner(children) = part {
                waiting.extend(children.into_iter().rev().map(|(at, bounds)| (at, bounds, depth + 1)));
            }
        }

        // What is below a node ends before the next node that is not deeper.
        let mut open_nodes: Vec<usize> = vec![];
        for number in 0..=outline.nodes.len() {
            let (depth, first) = match outline.nodes.get(number) {
                Some(node) => (node.depth, node.first),
                None => (0, outline.references.len()),
            };
            while let Some(&above) = open_nodes.last().filter(|&&above| outline.nodes[above].depth >= depth) {
                (outline.nodes[above].end, outline.nodes[above].last) = (number, first);
                open_nodes.pop();
            }
            open_nodes.push(number);
        }
        outline
    }

    /// The same tree, of which the nodes are known to share no inside.
    pub fn of_cells(self) -> Self {
        Self { disjoint: true, ..self }
    }

    /// Counts the nodes and sums their cost.
    pub fn shape(&self) -> TreeShape {
        let mut shape = TreeShape::default();
        let mut cost = 0.0;
        for node in &self.nodes {
            cost += node.bounds.half_area() * node.cost();
            if !node.leaf {
                shape.inner += 1;
                continue;
            }
            let count = node.last - node.first;
            shape.leaves += 1;
            shape.empty += usize::from(count == 0);
            shape.references += count;
            shape.largest_leaf = shape.largest_leaf.max(count);
            shape.depth = shape.depth.max(node.depth);
            shape.leaf_sizes.add(count);
            shape.leaf_depths.add(node.depth);
        }
        let root = self.nodes.first().map_or(0.0, |node| node.bounds.half_area());
        shape.sah_cost = (root > 0.0 && root.is_finite()).then(|| cost / root);
        shape
    }
}

impl OutlineNode {
    /// What it costs a ray to enter it.
    pub fn cost(&self) -> f64 {
        if self.leaf { TreeShape::leaf_cost(self.last - self.first) } else { TreeShape::INNER_COST }
    }
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::*;

    /// Inner nodes and leaves as a test writes them.
    enum Tree {
        Node(Vec<Tree>),
        Leaf(Vec<u32>),
    }

    fn outline(tree: &Tree) -> Outline {
        let unit = Aabb { min: Vec3::ZERO, max: Vec3::ONE };
        Outline::of(Some((tree, unit)), |tree, bounds, references| match tree {
            Tree::Leaf(ids) => {
                references.extend(ids);
                Part::Leaf
            }
            Tree::Node(children) => {
                let (mut low, mut high) = (*bounds, *bounds);
                (low.max.x, high.min.x) = (bounds.centre().x, bounds.centre().x);
                Part::Inner(children.iter().zip([low, high]).collect())
            }
        })
    }

    #[test]
    fn what_is_below_a_node_stands_in_a_row() {
        use Tree::{Leaf, Node};
        let tree = Node(vec![Node(vec![Leaf(vec![4, 2]), Leaf(vec![])]), Leaf(vec![2, 0, 1])]);
        let outline = outline(&tree);
        assert_eq!(outline.references, [4, 2, 2, 0, 1]);
        let rows: Vec<_> = outline.nodes.iter().map(|n| (n.depth, n.leaf, n.first, n.last, n.end)).collect();
        let expected =
            [(0, false, 0, 5, 5), (1, false, 0, 2, 4), (2, true, 0, 2, 3), (2, true, 2, 2, 4), (1, true, 2, 5, 5)];
        assert_eq!(rows, expected);

        let shape = outline.shape();
        assert_eq!((shape.inner, shape.leaves, shape.empty, shape.references), (2, 3, 1, 5));
        assert_eq!((shape.depth, shape.largest_leaf), (2, 3));
        assert_eq!(shape.leaf_sizes.iter().collect::<Vec<_>>(), [(0, 1), (2, 1), (3, 1)]);
        assert_eq!(shape.leaf_depths.iter().collect::<Vec<_>>(), [(1, 1), (2, 2)]);
        // Half areas 3, 2 and 1.5: (1.2 * 3 + 1.2 * 2 + 2 * 1.5 + 3 * 2) / 3.
        assert!((shape.sah_cost.unwrap() - 5.0).abs() < 1e-12, "{shape:?}");
    }

    #[test]
    fn no_tree_and_a_single_leaf_have_a_shape() {
        let nothing = Outline::of(None::<((), Aabb)>, |_, _, _| Part::Leaf);
        assert_eq!(nothing.shape(), TreeShape::default());
        let leaf = outline(&Tree::Leaf(vec![7]));
        assert_eq!((leaf.nodes[0].end, leaf.nodes[0].last), (1, 1));
        assert_eq!(leaf.shape().sah_cost, Some(1.0));
    }
}
