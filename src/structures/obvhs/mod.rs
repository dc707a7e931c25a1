//! The baseline: the BVHs of the crate `obvhs`, adapted without handicap. Nothing else in this crate imports it.
//!
//! Each is offered over our triangle tests and over obvhs' own [`RtTest`], which is its fastest form. Triangles are laid out
//! in the order of the tree once, so that no traversal follows an index; the number of the final hit is mapped back once. The ray
//! is prepared once with obvhs' own inverse direction, and its own traversals run to the end.
//!
//! Known defects of obvhs 0.4.0, which the validation shows and does not hide: `CwBvh` misses every ray with a direction
//! component of -0.0 and loses hits with t < 1e-4; both lose axis-parallel rays close to a box face, and rays with short
//! directions; the build takes quadratic time on coincident triangles.

mod bvh2;
mod config;
mod cwbvh;
mod leaf_test;
mod rt_test;

use std::sync::Arc;

use glam::Vec3A;
use obvhs::ray::{Ray as PreparedRay, RayHit};
use obvhs::triangle::Triangle;

pub use bvh2::ObvhsBvh2;
pub use config::{ObvhsConfig, Preset};
pub use cwbvh::ObvhsCwBvh;
pub use leaf_test::{LeafTest, Native, Over};
pub use rt_test::RtTest;

use crate::geometry::{Hit, Mesh, Ray};

/// Triangles in the order of a tree, ready for the test `T`.
struct Leaves<T: LeafTest> {
    triangles: Vec<T::Triangle>,
    /// The triangle of the mesh for each of them.
    ids: Vec<u32>,
}

/// What the builders of obvhs take: the triangles with an area, and their numbers.
fn input(mesh: &Mesh) -> (Vec<Triangle>, Vec<u32>) {
    let ids: Vec<u32> = mesh.solid().collect();
    let triangle = |&id: &u32| {
        let [v0, v1, v2] = mesh.corners(id).map(Vec3A::from);
        Triangle { v0, v1, v2 }
    };
    (ids.iter().map(triangle).collect(), ids)
}

impl<T: LeafTest> Leaves<T> {
    fn new(mesh: &Arc<Mesh>, solid: &[u32], order: &[u32]) -> Self {
        let ids: Vec<u32> = order.iter().map(|&i| solid[i as usize]).collect();
        let triangles = ids.iter().map(|&id| T::triangle(mesh.corners(id))).collect();
        Self { triangles, ids }
    }

    /// The ray in the form of obvhs and of the test; nothing if it can hit nothing.
    #[inline(always)]
    fn start(ray: &Ray) -> Option<(PreparedRay, T::Ray)> {
        let (t_min, t_max) = ray.interval();
        ray.is_valid().then(|| {
            let prepared = PreparedRay::new(ray.origin.into(), ray.direction.into(), t_min, t_max);
            (prepared, T::prepare(ray))
        })
    }

    /// `t` of triangle `index` of the tree, infinity for a miss.
    #[inline(always)]
    fn test(&self, ray: &PreparedRay, prepared: &T::Ray, index: usize) -> f32 {
        T::test(&self.triangles[index], ray, prepared)
    }

    /// Bytes of the triangles and of their numbers.
    fn bytes(&self) -> (usize, usize) {
        (size_of_val(&self.triangles[..]), size_of_val(&self.ids[..]))
    }

    #[inline(always)]
    fn hit(&self, found: bool, hit: &RayHit) -> Option<Hit> {
        found.then(|| Hit::new(hit.t, self.ids[hit.primitive_id as usize]))
    }
}
