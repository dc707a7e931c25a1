//! The baseline: the BVHs of the crate `obvhs`, adapted without handicap. Nothing else in this crate imports it.
//!
//! Each is offered over our triangle tests and over obvhs' own [`RtTest`], which is its fastest form. Triangles are laid out
//! in the order of the tree once, so that no traversal follows an index; the number of the final hit is mapped back once. The ray
//! is prepared once with obvhs' own inverse direction, and its own traversals run to the end. It is prepared inside of the timed
//! region: made ready before the clock starts ([`Accel::load`]), rays were not answered faster, and those that miss the
//! scene more slowly.
//!
//! Known defects of obvhs 0.4.0, which the validation shows and does not hide: `CwBvh` misses every ray with a direction
//! component of -0.0 and loses hits with t < 1e-4; both lose axis-parallel rays close to a box face, and rays with short
//! directions; the build takes quadratic time on coincident triangles.

mod bvh2;
mod config;
mod cwbvh;
mod leaf_test;
mod leaves;
mod rt_test;

use std::sync::Arc;

use obvhs::BvhBuildParams;
use obvhs::bvh2::Bvh2;
use obvhs::cwbvh::CwBvh;
use obvhs::ray::{Ray as PreparedRay, RayHit};
use obvhs::triangle::Triangle;

pub use config::{ObvhsConfig, Preset};
pub use leaf_test::{LeafTest, Native, Over};
pub use rt_test::RtTest;

use crate::accel::{Accel, BuildError, Footprint, Observer, Outline, TreeShape};
use crate::geometry::{Aabb, Hit, Mesh, Ray};
use leaves::{Leaves, input};

/// The binary BVH of obvhs.
pub type ObvhsBvh2<T> = Obvhs<Bvh2, T>;

/// The compressed 8-wide BVH of obvhs.
pub type ObvhsCwBvh<T> = Obvhs<CwBvh, T>;

/// A BVH of obvhs over the triangle test `T`.
pub struct Obvhs<B, T: LeafTest> {
    tree: B,
    leaves: Leaves<T>,
}

/// A box of obvhs as ours.
fn aabb(bounds: obvhs::aabb::Aabb) -> Aabb {
    Aabb { min: bounds.min.into(), max: bounds.max.into() }
}

/// What the two trees of obvhs have in common. Tests give `t` of a triangle in the order of the tree, infinity for a miss.
pub trait Tree: Send + Sync + Sized + 'static {
    fn build(triangles: &[Triangle], params: BvhBuildParams) -> Self;

    /// The triangle for each place in the tree.
    fn order(&self) -> &[u32];

    fn node_bytes(&self) -> usize;

    fn closest(&self, ray: PreparedRay, test: impl FnMut(&PreparedRay, usize) -> f32) -> Option<RayHit>;

    fn any(&self, ray: PreparedRay, test: impl FnMut(&PreparedRay, usize) -> f32) -> bool;

    /// As `closest`, or with `ANY` up to the first hit, telling the observer. The tree is not empty.
    fn watched<const ANY: bool>(
        &self,
        ray: &PreparedRay,
        test: impl FnMut(&PreparedRay, usize) -> f32,
        observer: &mut impl Observer,
    ) -> Option<RayHit>;

    /// Its boxes; references are places in the tree.
    fn outline(&self) -> Outline;
}

impl<B: Tree, T: LeafTest> Accel for Obvhs<B, T> {
    type Config = ObvhsConfig;

    const TRIANGLE_TEST: &'static str = T::NAME;

    fn build(mesh: &Arc<Mesh>, config: &ObvhsConfig) -> Result<Self, BuildError> {
        let (triangles, solid) = input(mesh);
        let tree = B::build(&triangles, config.preset.params());
        let leaves = Leaves::new(mesh, &solid, tree.order());
        Ok(Self { tree, leaves })
    }

    #[inline]
    fn closest_hit<O: Observer>(&self, ray: &Ray, observer: &mut O) -> Option<Hit> {
        let (ray, prepared) = self.leaves.start(ray)?;
        let test = self.leaves.test(prepared);
        let found =
            if O::ACTIVE { self.tree.watched::<false>(&ray, test, observer) } else { self.tree.closest(ray, test) };
        found.map(|hit| self.leaves.hit(hit))
    }

    #[inline]
    fn any_hit<O: Observer>(&self, ray: &Ray, observer: &mut O) -> bool {
        let Some((ray, prepared)) = self.leaves.start(ray) else { return false };
        let test = self.leaves.test(prepared);
        if O::ACTIVE { self.tree.watched::<true>(&ray, test, observer).is_some() } else { self.tree.any(ray, test) }
    }

    fn footprint(&self) -> Footprint {
        let (triangles, references) = self.leaves.bytes();
        Footprint { nodes: self.tree.node_bytes(), references, triangles, other: 0 }
    }

    fn shape(&self) -> TreeShape {
        self.tree.outline().shape()
    }

    fn outline(&self) -> Option<Outline> {
        let mut outline = self.tree.outline();
        outline.references.iter_mut().for_each(|place| *place = self.leaves.id(*place));
        Some(outline)
    }
}
