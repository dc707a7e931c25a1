use super::WideTree;
use crate::accel::{Outline, Part};
use crate::triangle::TriangleTest;

/// The boxes of the tree, eight to a node at most.
pub(super) fn of<T: TriangleTest>(tree: &WideTree<T>) -> Outline {
    Outline::of(Some((tree.root, tree.bounds)), |child, _, references| match child.blocks() {
        Some((first, count)) => {
            references.extend(tree.blocks[first..first + count].iter().flat_map(|block| block.ids()));
            Part::Leaf
        }
        None => Part::Inner(tree.nodes[child.index()].boxes().map(|(bounds, child)| (child, bounds)).collect()),
    })
}
