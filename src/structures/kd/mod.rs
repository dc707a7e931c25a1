//! KD-trees: the report's median tree and the SAH tree are two configurations of one type.

mod build;
mod cells;
pub(super) mod clip;
mod config;
mod median;
mod node;
mod outline;
mod planted;
mod sah;
mod sah_binned;
mod sah_sweep;
#[cfg(test)]
mod tests;
mod traverse;

use std::sync::Arc;

pub use config::{AxisRule, CountOf, Equal, Exit, KdConfig, Limit, Median, Plane, Stop, Traversal};

use super::binary::BinaryTree;
use super::leaf::LeafBlock;
use super::pages;
use super::walk::single;
use crate::accel::{Accel, BuildError, Footprint, Observer, Outline, TreeShape};
use crate::geometry::{Aabb, Hit, Mesh, Ray};
use crate::triangle::TriangleTest;
use build::{Context, Plan, grow};
use cells::Cells;
use median::Triangles;
use node::{Limits, Node};
use sah_binned::Binned;

/// Triangles that a leaf tests at once.
const WIDTH: usize = 8;

/// A binary space partition by axis-aligned planes: 8-byte nodes in depth-first order, leaves of blocks of triangles.
///
/// Its configuration says where planes go, when nodes stay leaves and how rays walk. Building takes O(n log n) time and
/// memory for a bounded duplication of references; the tree is the same for every number of threads.
///
/// # References
/// Wald, Havran: On building fast kd-trees for ray tracing, and on doing that in O(N log N), 2006. Havran: Heuristic Ray Shooting
/// Algorithms, 2000. Not for moving geometry: nothing can be updated.
pub struct KdTree<T: TriangleTest> {
    nodes: Vec<Node>,
    blocks: Vec<LeafBlock<T, WIDTH>>,
    bounds: Aabb,
    config: KdConfig,
}

/// Grows the tree that `config` describes, if it stays within the limits.
fn plan(mesh: &Mesh, config: &KdConfig, limits: &Limits) -> Result<Plan, BuildError> {
    config.check()?;
    // Every triangle takes a reference: what cannot end well need not begin.
    limits.check(1, mesh.solid().count())?;
    let context = Context::new(mesh, config);
    let plan: Plan = match config.plane {
        Plane::VertexMedian | Plane::SpatialMedian | Plane::CentroidMedian => grow(&context, Triangles::all(&context)),
        Plane::SahBinned | Plane::SahSweep => grow(&context, Binned::all(&context)),
    };
    // What nodes name only grows: if the last of it can be named, all of it could.
    limits.check(plan.nodes.len(), plan.references.len())?;
    Ok(plan)
}

/// The cells of that tree that are not empty, as tight boxes. Its plane must be chosen by the surface area heuristic.
pub(crate) fn partition(mesh: &Mesh, config: &KdConfig) -> Result<BinaryTree, BuildError> {
    assert!(matches!(config.plane, Plane::SahBinned | Plane::SahSweep), "cells are chosen by the heuristic");
    config.check()?;
    let context = Context::new(mesh, config);
    let Cells(tree) = grow(&context, Binned::all(&context));
    Ok(tree)
}

impl<T: TriangleTest> KdTree<T> {
    /// Turns the references of a plan into blocks, leaf by leaf.
    fn finish(mesh: &Mesh, config: &KdConfig, plan: Plan) -> Self {
        let Plan { mut nodes, references } = plan;
        let leaves = nodes.iter().filter(|node| node.is_leaf());
        let count = leaves.map(|leaf| (leaf.references() as usize).div_ceil(WIDTH)).sum();
        let mut blocks = pages::with_capacity(count);
        for node in nodes.iter_mut().filter(|node| node.is_leaf()) {
            let (first, count) = (node.first() as usize, node.references());
            *node = Node::leaf(blocks.len() as u32, count);
            LeafBlock::fill(mesh, &references[first..first + count as usize], &mut blocks);
        }
        Self { nodes: pages::moved(nodes), blocks, bounds: mesh.bounds(), config: *config }
    }

    #[inline(always)]
    fn blocks_of(&self, leaf: Node) -> &[LeafBlock<T, WIDTH>] {
        let first = leaf.first() as usize;
        &self.blocks[first..first + (leaf.references() as usize).div_ceil(WIDTH)]
    }
}

impl<T: TriangleTest> Accel for KdTree<T> {
    type Config = KdConfig;

    const TRIANGLE_TEST: &'static str = T::NAME;

    fn build(mesh: &Arc<Mesh>, config: &KdConfig) -> Result<Self, BuildError> {
        Ok(Self::finish(mesh, config, plan(mesh, config, &Limits::OF_NODES)?))
    }

    #[inline]
    fn closest_hit<O: Observer>(&self, ray: &Ray, observer: &mut O) -> Option<Hit> {
        planted::slow_down::<false, T>(self, ray);
        single::<false, _, O>(self, ray, observer)
    }

    #[inline]
    fn any_hit<O: Observer>(&self, ray: &Ray, observer: &mut O) -> bool {
        planted::slow_down::<true, T>(self, ray);
        single::<true, _, O>(self, ray, observer).is_some()
    }

    fn footprint(&self) -> Footprint {
        let (triangles, references) = LeafBlock::<T, WIDTH>::BYTES;
        let n = self.blocks.len();
        Footprint {
            nodes: size_of_val(&self.nodes[..]),
            triangles: n * triangles,
            references: n * references,
            other: size_of::<Self>(),
        }
    }

    fn shape(&self) -> TreeShape {
        outline::of(self).shape()
    }

    fn outline(&self) -> Option<Outline> {
        Some(outline::of(self))
    }
}
