use super::config::KdConfig;
use super::node::Node;
use super::sah::CostModel;
use crate::accel::TreeShape;
use crate::geometry::Aabb;

/// Counts the tree and sums its SAH cost, in units of one triangle test.
pub(super) fn of(nodes: &[Node], bounds: Aabb, config: &KdConfig) -> TreeShape {
    let model = CostModel::new(config);
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
            cost += area(&cell) * model.leaf(count);
        } else {
            let (below, above) = cell.cut(node.axis(), node.split());
            shape.inner += 1;
            cost += area(&cell) * f64::from(config.traversal_cost);
            stack.push((node.above() as usize, above, depth + 1));
            stack.push((at + 1, below, depth + 1));
        }
    }
    let root = area(&bounds);
    shape.sah_cost = (root > 0.0).then(|| cost / root / model.leaf(1));
    shape
}
