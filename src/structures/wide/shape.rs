use super::node::{Child, Node, WIDTH};
use crate::accel::TreeShape;
use crate::geometry::Aabb;
use crate::structures::extent::Extent;
use crate::structures::leaf::LeafBlock;
use crate::triangle::TriangleTest;

/// Counts the tree and sums its SAH cost, a node costing as much as any inner node.
pub(super) fn of<T: TriangleTest>(
    root: Child,
    nodes: &[Node],
    blocks: &[LeafBlock<T, WIDTH>],
    bounds: &Aabb,
) -> TreeShape {
    let mut shape = TreeShape::default();
    let mut cost = 0.0;
    let mut stack = vec![(root, *bounds, 0)];
    while let Some((child, bounds, depth)) = stack.pop() {
        let area = Extent::from(bounds).half_area();
        if let Some((first, count)) = child.blocks() {
            let references = blocks[first..first + count].iter().map(|block| block.len() as usize).sum();
            shape.leaves += 1;
            shape.empty += usize::from(references == 0);
            shape.references += references;
            shape.largest_leaf = shape.largest_leaf.max(references);
            shape.depth = shape.depth.max(depth);
            cost += area * TreeShape::leaf_cost(references);
        } else {
            shape.inner += 1;
            cost += area * TreeShape::INNER_COST;
            let node = &nodes[child.index()];
            stack.extend(node.boxes().map(|(bounds, child)| (child, bounds, depth + 1)));
        }
    }
    let root = Extent::from(*bounds).half_area();
    shape.sah_cost = (root > 0.0 && root.is_finite()).then(|| cost / root);
    shape
}
