use super::node::Node;
use super::tree::KdTree;
use crate::accel::{Outline, Part};
use crate::triangle::TriangleTest;

impl<T: TriangleTest> KdTree<T> {
    pub(super) fn cells(&self) -> Outline {
        let outline = Outline::of(Some((0, self.bounds)), |at, cell, references| {
            let node: Node = self.nodes[at];
            if node.is_leaf() {
                let blocks = self.blocks_of(node);
                references.extend(blocks.iter().flat_map(|block| block.ids()));
                return Part::Leaf;
            }
            let (below, above) = cell.cut(node.axis(), node.split());
            Part::Inner(vec![(at + 1, below), (node.above() as usize, above)])
        });
        outline.of_cells()
    }
}
