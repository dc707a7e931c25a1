use super::KdTree;
use super::node::Node;
use crate::accel::{Outline, Part};
use crate::triangle::TriangleTest;

/// The cells of the tree.
pub(super) fn of<T: TriangleTest>(tree: &KdTree<T>) -> Outline {
    let outline = Outline::of(Some((0, tree.bounds)), |at, cell, references| {
        let node: Node = tree.nodes[at];
        if node.is_leaf() {
            let blocks = tree.blocks_of(node);
            references.extend(blocks.iter().flat_map(|block| block.ids()));
            return Part::Leaf;
        }
        let (below, above) = cell.cut(node.axis(), node.split());
        Part::Inner(vec![(at + 1, below), (node.above() as usize, above)])
    });
    outline.of_cells()
}
