use std::sync::Arc;

use serde::{Deserialize, Serialize};

use super::leaf::{LeafBlock, search, start};
use super::walk::{Walk, single};
use crate::accel::{Accel, BuildError, Footprint, Observer, Outline, Part, TreeShape};
use crate::geometry::{Aabb, Hit, Mesh, Ray};
use crate::simd::Sieve;
use crate::triangle::TriangleTest;

/// Every triangle, tested in order: the reference that all others are held against.
///
/// Eight triangles at a time, which gives the bits of the scalar test.
pub struct BruteForce<T: TriangleTest> {
    blocks: Vec<LeafBlock<T, 8>>,
    references: usize,
}

/// Nothing to configure.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BruteForceConfig {}

impl<T: TriangleTest> BruteForce<T> {
    /// All triangles in the whole of space.
    fn leaf(&self) -> Outline {
        let everywhere = Aabb { min: glam::Vec3::NEG_INFINITY, max: glam::Vec3::INFINITY };
        let outline = Outline::of(Some(((), everywhere)), |(), _, references| {
            references.extend(self.blocks.iter().flat_map(|block| block.ids()));
            Part::Leaf
        });
        outline.of_cells()
    }
}

impl<T: TriangleTest> Walk for BruteForce<T> {
    #[inline(always)]
    fn walk<const ANY: bool, L: Sieve, O: Observer>(&self, ray: &Ray, observer: &mut O) -> Option<Hit> {
        let (t_min, mut nearest) = start::<T>(ray)?;
        let prepared = T::prepare(ray);
        observer.leaf(self.references as u32);
        let count = self.references as u32;
        let tests = search::<ANY, 8, L, T>(&self.blocks, count, &prepared, t_min, &mut nearest, &mut None);
        observer.test(tests);
        nearest.hit()
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

    fn closest_hit<O: Observer>(&self, ray: &Ray, observer: &mut O) -> Option<Hit> {
        single::<false, _, O>(self, ray, observer)
    }

    fn any_hit<O: Observer>(&self, ray: &Ray, observer: &mut O) -> bool {
        single::<true, _, O>(self, ray, observer).is_some()
    }

    fn footprint(&self) -> Footprint {
        let (triangles, references) = LeafBlock::<T, 8>::BYTES;
        let n = self.blocks.len();
        Footprint { triangles: n * triangles, references: n * references, ..Footprint::default() }
    }

    fn shape(&self) -> TreeShape {
        // Every ray enters it, whatever its box.
        TreeShape { sah_cost: Some(self.references as f64), ..self.leaf().shape() }
    }

    fn outline(&self) -> Option<Outline> {
        Some(self.leaf())
    }
}
