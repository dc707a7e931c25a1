//! The BVHs of the crate `obvhs`.
//!
//! The adapter requests huge pages for nodes and triangles. `build` checks all links once. Traversals read nodes and
//! triangles without bounds checks.
//!
//! Known defects of obvhs 0.4.0:
//! - `CwBvh` loses all hits of rays with a direction component of -0.0.
//! - `CwBvh` loses hits with t < 1e-4.
//! - `Bvh2` and `CwBvh` lose hits of axis-parallel rays close to a box face.
//! - `Bvh2` and `CwBvh` lose hits of rays with short directions.
//! - The build takes quadratic time on coincident triangles.

mod bvh2;
mod cwbvh;
mod leaf_test;
mod leaves;
#[cfg(test)]
mod tests;

use std::mem;
use std::sync::Arc;

use obvhs::BvhBuildParams;
use obvhs::bvh2::Bvh2;
use obvhs::cwbvh::CwBvh;
use obvhs::ray::{Ray as PreparedRay, RayHit};
use obvhs::triangle::Triangle;
use serde::{Deserialize, Serialize};

pub use leaf_test::{LeafTest, Native, Over, RtTest};

use crate::accel::{Accel, BuildError, Footprint, Observer, TreeShape};
use crate::geometry::{Aabb, Hit, Mesh, Ray};
use crate::traversal::pages;
use leaves::{Leaves, input};

/// The binary BVH of obvhs.
pub type ObvhsBvh2<T> = Obvhs<Bvh2, T>;

/// The compressed 8-wide BVH of obvhs.
pub type ObvhsCwBvh<T> = Obvhs<CwBvh, T>;

/// A BVH of obvhs with the triangle test `T`.
pub struct Obvhs<B, T: LeafTest> {
    tree: B,
    node_bytes: usize,
    leaves: Leaves<T>,
}

/// The build options of obvhs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ObvhsConfig {
    /// The preset of obvhs.
    pub preset: Preset,
}

/// The presets of obvhs, from the fastest build to the best tree. Only `slow` and `very-slow` split large triangles.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
#[allow(missing_docs)]
pub enum Preset {
    Fastest,
    VeryFast,
    Fast,
    Medium,
    Slow,
    #[default]
    VerySlow,
}

impl Preset {
    fn params(self) -> BvhBuildParams {
        match self {
            Self::Fastest => BvhBuildParams::fastest_build(),
            Self::VeryFast => BvhBuildParams::very_fast_build(),
            Self::Fast => BvhBuildParams::fast_build(),
            Self::Medium => BvhBuildParams::medium_build(),
            Self::Slow => BvhBuildParams::slow_build(),
            Self::VerySlow => BvhBuildParams::very_slow_build(),
        }
    }
}

fn aabb(bounds: obvhs::aabb::Aabb) -> Aabb {
    Aabb { min: bounds.min.into(), max: bounds.max.into() }
}

/// The interface of the trees of obvhs. A position is the index of a triangle in leaf order.
pub trait Tree: Send + Sync + Sized + 'static {
    /// A node.
    type Node: Copy;

    /// Builds the tree.
    fn build(triangles: &[Triangle], params: BvhBuildParams) -> Self;

    /// The nodes, and one triangle index per position.
    fn arrays(&mut self) -> (&mut Vec<Self::Node>, &mut Vec<u32>);

    /// Returns true if all links are valid. A link to a node must lead to an existing node. A position in a leaf must
    /// be below `triangles`.
    fn leads_inside(&self, triangles: usize) -> bool;

    /// Returns the closest hit. With `ANY`, returns the first hit that the traversal finds. `test` receives a position.
    /// `test` returns infinity for a miss.
    ///
    /// # Safety
    /// `test` must accept all positions below a number `n`. [`Tree::leads_inside`] must return true for `n`.
    unsafe fn walk<const ANY: bool>(
        &self,
        ray: PreparedRay,
        test: impl FnMut(&PreparedRay, usize) -> f32,
        observer: &mut impl Observer,
    ) -> Option<RayHit>;

    /// The shape of the tree.
    fn shape(&self) -> TreeShape;
}

impl<B: Tree, T: LeafTest> Accel for Obvhs<B, T> {
    type Config = ObvhsConfig;

    const TRIANGLE_TEST: &'static str = T::NAME;

    fn build(mesh: &Arc<Mesh>, config: &ObvhsConfig) -> Result<Self, BuildError> {
        let (triangles, solid) = input(mesh);
        let mut tree = B::build(&triangles, config.preset.params());
        drop(triangles);
        let (nodes, order) = tree.arrays();
        *nodes = pages::moved(mem::take(nodes));
        let (node_bytes, order) = (size_of_val(&nodes[..]), mem::take(order));
        let leaves = Leaves::new(mesh, &solid, &order);
        assert!(tree.leads_inside(leaves.len()), "obvhs has built a tree with invalid links");
        Ok(Self { tree, node_bytes, leaves })
    }

    #[inline]
    fn closest_hit<O: Observer>(&self, ray: &Ray, observer: &mut O) -> Option<Hit> {
        let (ray, prepared) = self.leaves.start(ray)?;
        // SAFETY: `build` has asserted `leads_inside` for `leaves.len()`. Therefore `walk` passes only positions below
        // `leaves.len()` to `test`.
        let found = unsafe { self.tree.walk::<false>(ray, self.leaves.test(prepared), observer) };
        found.map(|hit| self.leaves.hit(hit))
    }

    #[inline]
    fn any_hit<O: Observer>(&self, ray: &Ray, observer: &mut O) -> bool {
        let Some((ray, prepared)) = self.leaves.start(ray) else { return false };
        // SAFETY: as in `closest_hit`.
        unsafe { self.tree.walk::<true>(ray, self.leaves.test(prepared), observer) }.is_some()
    }

    fn footprint(&self) -> Footprint {
        Footprint { nodes: self.node_bytes, ..self.leaves.footprint() }
    }

    fn shape(&self) -> TreeShape {
        self.tree.shape()
    }
}
