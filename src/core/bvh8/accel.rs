use std::sync::Arc;

use super::batch::answer;
use super::config::Bvh8Config;
use super::node::Limits;
use super::tree::Bvh8;
use crate::accel::{Accel, BuildError, Footprint, Observer, Part, TreeShape};
use crate::geometry::{Hit, Mesh, Ray};
use crate::traversal::leaf::LeafBlock;
use crate::traversal::walk::walked_queries;
use crate::triangle::TriangleTest;

impl<T: TriangleTest> Accel for Bvh8<T> {
    type Config = Bvh8Config;

    const TRIANGLE_TEST: &'static str = T::NAME;

    fn build(mesh: &Arc<Mesh>, config: &Bvh8Config) -> Result<Self, BuildError> {
        Self::within(mesh, config, &Limits::OF_NODES)
    }

    walked_queries!();

    fn closest_hits<O: Observer>(&self, rays: &[Ray], hits: &mut [Option<Hit>], observer: &mut O) {
        answer::<false, _, _, O>(self, rays, hits, observer, |hit| hit);
    }

    fn any_hits<O: Observer>(&self, rays: &[Ray], hits: &mut [bool], observer: &mut O) {
        answer::<true, _, _, O>(self, rays, hits, observer, |hit| hit.is_some());
    }

    fn footprint(&self) -> Footprint {
        let nodes = size_of_val(&self.nodes[..]);
        Footprint { nodes, other: size_of::<Self>(), ..LeafBlock::footprint(&self.blocks) }
    }

    fn shape(&self) -> TreeShape {
        TreeShape::of(Some((self.root, self.bounds)), |child, _| match child.blocks() {
            Some((first, count)) => {
                Part::Leaf(self.blocks[first..first + count].iter().map(|block| block.len() as usize).sum())
            }
            None => Part::Inner(self.nodes[child.index()].boxes().map(|(bounds, child)| (child, bounds)).collect()),
        })
    }
}
