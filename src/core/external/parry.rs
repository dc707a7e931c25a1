//! [parry](https://github.com/dimforge/parry) 0.31 (crate `parry3d`): a binary BVH, one triangle per leaf.
//!
//! parry computes the inverse direction in every query, because parry accepts no precomputed inverse.
//!
//! parry has no any-hit query for rays. The any-hit query of this module reports a hit to parry at t = -infinity.
//! parry then skips all remaining boxes, because every box distance exceeds -infinity.

use std::cell::Cell;
use std::sync::Arc;

use ::parry3d::bounding_volume::Aabb;
use ::parry3d::math::Vector;
use ::parry3d::partitioning::{Bvh, BvhBuildStrategy};
use ::parry3d::query::Ray as PreparedRay;
use ::parry3d::query::details::local_ray_intersection_with_triangle;
use glam::Vec3;

use super::leaves::{Leaves, Start};
use crate::accel::{Accel, BuildError, Footprint, Observed, Observer, TreeShape};
use crate::external::lanes;
use crate::external::prepared::{Prepare, prepared_queries};
use crate::geometry::{Hit, Mesh, Ray};
use crate::simd::Lanes;
use crate::triangle::TriangleTest;
use crate::triangle::decided_at_once::decided_at_once;

/// The BVH of parry with the triangle test `T`.
pub struct ParryBvh<T: TriangleTest> {
    tree: Bvh,
    leaves: Leaves<T>,
}

fn vector(v: Vec3) -> Vector {
    Vector::new(v.x, v.y, v.z)
}

pub(crate) struct Ready<T: TriangleTest> {
    walked: PreparedRay,
    t_max: f32,
    start: Start<T>,
}

impl<T: TriangleTest> ParryBvh<T> {
    #[inline]
    fn query<const ANY: bool, O: Observer>(&self, ready: &Ready<T>, observer: &mut O) -> Option<Hit> {
        let Ready { walked, t_max, start } = ready;
        let (nearest, tests) = (Cell::new(start.nearest()), Cell::new(0));
        self.tree.cast_ray(walked, *t_max, |leaf, _| {
            let mut best = nearest.get();
            if ANY && best.found() {
                return None;
            }
            tests.set(tests.get() + 1);
            self.leaves.test(leaf as usize, start, &mut best);
            nearest.set(best);
            best.found().then_some(if ANY { f32::NEG_INFINITY } else { best.t })
        });
        (0..tests.get()).for_each(|_| observer.test(1));
        nearest.get().answer::<ANY>(&start.original)
    }
}

impl<T: TriangleTest> Prepare for ParryBvh<T> {
    type Ready = Ready<T>;

    #[inline(always)]
    fn ready(&self, ray: &Ray) -> Option<Ready<T>> {
        let start = Start::new(ray)?;
        let walked = PreparedRay::new(vector(ray.origin), vector(ray.direction));
        Some(Ready { walked, t_max: ray.interval().1, start })
    }

    #[inline]
    fn closest<O: Observer>(&self, ready: &Ready<T>, observer: &mut O) -> Option<Hit> {
        self.query::<false, O>(ready, observer)
    }

    #[inline]
    fn any<O: Observer>(&self, ready: &Ready<T>, observer: &mut O) -> bool {
        self.query::<true, O>(ready, observer).is_some()
    }
}

impl<T: TriangleTest> Accel for ParryBvh<T> {
    type Config = ();

    const TRIANGLE_TEST: &'static str = T::NAME;
    const OBSERVED: Observed = Observed::TESTS;
    const CONVENTIONS: &'static [&'static str] = &["builds on one thread"];

    fn build(mesh: &Arc<Mesh>, (): &()) -> Result<Self, BuildError> {
        let leaves = Leaves::new(mesh);
        let boxes = leaves.boxes(mesh).map(|bounds| Aabb::new(vector(bounds.min), vector(bounds.max)));
        let tree = Bvh::from_iter(BvhBuildStrategy::Binned, boxes.enumerate());
        Ok(Self { tree, leaves })
    }

    prepared_queries!();

    /// `nodes` includes parry's tables for tree updates.
    fn footprint(&self) -> Footprint {
        Footprint { nodes: self.tree.total_memory_size(), ..self.leaves.footprint() }
    }

    fn shape(&self) -> TreeShape {
        let leaves = self.leaves.ids.len();
        if leaves <= 1 {
            return TreeShape::one_leaf(leaves);
        }
        TreeShape {
            inner: leaves - 1,
            leaves,
            references: leaves,
            // The depth in parry counts nodes. The depth in `TreeShape` counts edges.
            depth: self.tree.subtree_depth(0) as usize - 1,
            largest_leaf: 1,
            ..TreeShape::default()
        }
    }
}

/// The two-sided triangle test of parry: Möller-Trumbore with the triangle's normal, without an epsilon.
#[derive(Clone, Copy, Debug, Default)]
pub struct ParryTest;

impl TriangleTest for ParryTest {
    const NAME: &'static str = "parry-triangle";

    type Ray = PreparedRay;
    type Block<const N: usize> = [[Vector; 3]; N];

    decided_at_once!();

    #[inline(always)]
    fn prepare(ray: &Ray) -> PreparedRay {
        PreparedRay::new(vector(ray.origin), vector(ray.direction))
    }

    fn block<const N: usize>(triangles: &[[Vec3; 3]]) -> [[Vector; 3]; N] {
        lanes::block(triangles, |corners| corners.map(vector))
    }

    #[inline(always)]
    fn candidates<const N: usize, L: Lanes<N>>(
        ray: &PreparedRay,
        block: &[[Vector; 3]; N],
        from: f32,
        to: f32,
    ) -> (u32, L) {
        lanes::candidates(from, to, |lane| {
            let [a, b, c] = block[lane];
            let hit = local_ray_intersection_with_triangle(a, b, c, ray);
            hit.map_or(f32::INFINITY, |(hit, _)| hit.time_of_impact)
        })
    }
}
