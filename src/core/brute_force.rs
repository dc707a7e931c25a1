use std::sync::Arc;

use serde::{Deserialize, Serialize};

use crate::accel::{Accel, BuildError, Footprint, Observer, TreeShape};
use crate::geometry::{Hit, Mesh, Ray};
use crate::simd::EightLanes;
use crate::traversal::leaf::{LeafBlock, search, start};
use crate::traversal::walk::{Walk, walked_queries};
use crate::triangle::TriangleTest;

/// Tests every triangle in order: the reference for all other structures.
///
/// It tests eight triangles at once; the results are bit-identical to the scalar test.
pub struct BruteForce<T: TriangleTest> {
    blocks: Vec<LeafBlock<T>>,
    references: usize,
}

/// No options.
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
        // Every ray enters it, regardless of its box.
        let sah_cost = Some(TreeShape::leaf_cost(self.references));
        TreeShape { sah_cost, ..TreeShape::one_leaf(self.references) }
    }
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::*;
    use crate::accel::Capabilities;
    use crate::triangle::Exact;

    /// Keeps the default any-hit query; declines `t_max` if `ENDS` is false.
    struct Plain<const ENDS: bool>(BruteForce<Exact>);

    impl<const ENDS: bool> Accel for Plain<ENDS> {
        type Config = BruteForceConfig;

        const CAPABILITIES: Capabilities = Capabilities { t_max: ENDS, ..Capabilities::ALL };

        fn build(mesh: &Arc<Mesh>, config: &BruteForceConfig) -> Result<Self, BuildError> {
            BruteForce::build(mesh, config).map(Self)
        }

        fn closest_hit<O: Observer>(&self, ray: &Ray, observer: &mut O) -> Option<Hit> {
            let asked = if ENDS { *ray } else { ray.until(f32::INFINITY) };
            self.0.closest_hit(&asked, observer)
        }

        fn footprint(&self) -> Footprint {
            self.0.footprint()
        }

        fn shape(&self) -> TreeShape {
            self.0.shape()
        }
    }

    /// The exact `t` is one third, just before the float to which it rounds.
    #[test]
    fn any_hit_is_by_default_whether_there_is_a_closest_hit() {
        let mesh = Arc::new(Mesh::new(vec![Vec3::X, Vec3::Y, Vec3::Z], vec![[0, 1, 2]]).unwrap());
        let third: f32 = 1.0 / 3.0;
        let ray = Ray::new(Vec3::ZERO, Vec3::ONE).until(third);
        let plain = Plain::<true>::build(&mesh, &BruteForceConfig {}).unwrap();
        assert_eq!(plain.closest_hit(&ray, &mut ()), Some(Hit::new(third, 0)));
        assert!(plain.any_hit(&ray, &mut ()));
        assert!(!plain.any_hit(&ray.until(third.next_down()), &mut ()));

        let endless = Plain::<false>::build(&mesh, &BruteForceConfig {}).unwrap();
        assert!(endless.closest_hit(&ray.until(0.2), &mut ()).is_some());
        assert!(!endless.any_hit(&ray.until(0.2), &mut ()) && endless.any_hit(&ray.until(0.4), &mut ()));
    }
}
