use super::tree::Bvh8;
use crate::accel::{Outline, Part};
use crate::triangle::TriangleTest;

impl<T: TriangleTest> Bvh8<T> {
    /// The boxes of the tree, eight to a node at most.
    pub(super) fn boxes(&self) -> Outline {
        Outline::of(Some((self.root, self.bounds)), |child, _, references| match child.blocks() {
            Some((first, count)) => {
                references.extend(self.blocks[first..first + count].iter().flat_map(|block| block.ids()));
                Part::Leaf
            }
            None => Part::Inner(self.nodes[child.index()].boxes().map(|(bounds, child)| (child, bounds)).collect()),
        })
    }
}
