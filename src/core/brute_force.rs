use std::sync::Arc;

use serde::{Deserialize, Serialize};

use crate::accel::{Accel, BuildError, Footprint, Observer, TreeShape};
use crate::geometry::{Hit, Mesh, Ray};
use crate::simd::EightLanes;
use crate::traversal::leaf::{LeafBlock, search, start};
use crate::traversal::walk::{Walk, walked_queries};
use crate::triangle::TriangleTest;

/// Tests all triangles that are not degenerate, without a tree.
///
/// The `t` of the nearest hit is bit-identical to the result of `triangle::scalar_hit` for the hit triangle.
pub struct BruteForce<T: TriangleTest> {
    blocks: Vec<LeafBlock<T>>,
    references: usize,
}

/// Brute force has no options.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BruteForceConfig {}

impl<T: TriangleTest> Walk for BruteForce<T> {
    #[inline(always)]
    fn walk<const ANY: bool, L: EightLanes, O: Observer>(&self, ray: &Ray, observer: &mut O) -> Option<Hit> {
        let (t_min, mut nearest) = start::<T>(ray)?;
        let prepared = T::prepare(ray);
        observer.leaf(self.references as u32);
        let count = self.references as u32;
        search::<ANY, L, T, O>(&self.blocks, count, &prepared, t_min, &mut nearest, &mut None, observer);
        nearest.answer::<ANY>(ray)
    }
}

impl<T: TriangleTest> Accel for BruteForce<T> {
    type Config = BruteForceConfig;

    const TRIANGLE_TEST: &'static str = T::NAME;

    fn build(mesh: &Arc<Mesh>, _: &BruteForceConfig) -> Result<Self, BuildError> {
        let ids: Vec<u32> = mesh.solid().collect();
        let mut blocks = Vec::with_capacity(ids.len().div_ceil(8));
        LeafBlock::fill(mesh, &ids, &mut blocks);
        Ok(Self { blocks, references: ids.len() })
    }

    walked_queries!();

    fn footprint(&self) -> Footprint {
        LeafBlock::footprint(&self.blocks)
    }

    fn shape(&self) -> TreeShape {
        let sah_cost = Some(self.references as f64);
        TreeShape { sah_cost, ..TreeShape::one_leaf(self.references) }
    }
}
