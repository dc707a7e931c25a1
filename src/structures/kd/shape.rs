use super::node::Node;
use crate::accel::TreeShape;
use crate::geometry::Aabb;

/// Counts the tree and sums its SAH cost, each cell by its own area.
pub(super) fn of(nodes: &[Node], bounds: Aabb) -> TreeShape {
    let area = |cell: &Aabb| f64::from(cell.half_area());
    let mut shape = TreeShape::default();
    let mut cost = 0.0;
    let mut stack = vec![(0, bounds, 0)];
    while let Some((at, cell, depth)) = stack.pop() {
        let node = nodes[at];
        if node.is_leaf() {
            let count = node.references() as usize;
            shape.leaves += 1;
            shape.empty += usize::from(count == 0);
            shape.references += count;
            shape.largest_leaf = shape.largest_leaf.max(count);
            shape.depth = shape.depth.max(depth);
            cost += area(&cell) * TreeShape::leaf_cost(count);
        } else {
            let (below, above) = cell.cut(node.axis(), node.split());
            shape.inner += 1;
            cost += area(&cell) * TreeShape::INNER_COST;
            stack.push((node.above() as usize, above, depth + 1));
            stack.push((at + 1, below, depth + 1));
        }
    }
    let root = area(&bounds);
    shape.sah_cost = (root > 0.0).then(|| cost / root);
    shape
}
