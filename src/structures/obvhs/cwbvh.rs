use std::sync::Arc;
use std::time::Duration;

use glam::UVec2;
use obvhs::cwbvh::CwBvh;
use obvhs::cwbvh::builder::build_cwbvh_from_tris;
use obvhs::ray::{Ray as PreparedRay, RayHit};
use obvhs::traverse;

use super::{LeafTest, Leaves, ObvhsConfig, input};
use crate::accel::{Accel, BuildError, Footprint, Observer, TreeShape};
use crate::geometry::{Hit, Mesh, Ray};

/// The compressed 8-wide BVH of obvhs: 80-byte nodes, at most three triangles a leaf.
///
/// # References
/// Ylitie, Karras, Laine: Efficient incoherent ray traversal on GPUs through compressed wide BVHs. HPG 2017.
pub struct ObvhsCwBvh<T: LeafTest> {
    bvh: CwBvh,
    leaves: Leaves<T>,
}

impl<T: LeafTest> ObvhsCwBvh<T> {
    /// The walk of obvhs through its own macro, watched. A group of triangles that a node hands over counts as no node of
    /// its own, so only inner nodes are steps.
    fn watched<const ANY: bool, O: Observer>(
        &self,
        ray: &PreparedRay,
        prepared: &T::Ray,
        observer: &mut O,
    ) -> Option<Hit> {
        let mut ray = *ray;
        let mut hit = RayHit::none();
        let mut state = self.bvh.new_traversal(ray.direction);
        let mut node;
        traverse!(
            self.bvh,
            node,
            state,
            {
                observer.inner();
                node.intersect_ray(&ray, state.oct_inv4)
            },
            {
                observer.test(1);
                let t = self.leaves.test(&ray, prepared, state.primitive_id as usize);
                if t < ray.tmax {
                    (hit.primitive_id, hit.t, ray.tmax) = (state.primitive_id, t, t);
                    if ANY {
                        return self.leaves.hit(true, &hit);
                    }
                }
            }
        );
        self.leaves.hit(hit.t < f32::INFINITY, &hit)
    }
}

impl<T: LeafTest> Accel for ObvhsCwBvh<T> {
    type Config = ObvhsConfig;

    const TRIANGLE_TEST: &'static str = T::NAME;

    fn build(mesh: &Arc<Mesh>, config: &ObvhsConfig) -> Result<Self, BuildError> {
        let (triangles, solid) = input(mesh);
        let bvh = build_cwbvh_from_tris(&triangles, config.preset.params(), &mut Duration::default());
        let leaves = Leaves::new(mesh, &solid, &bvh.primitive_indices);
        Ok(Self { bvh, leaves })
    }

    #[inline]
    fn closest_hit<O: Observer>(&self, ray: &Ray, observer: &mut O) -> Option<Hit> {
        let (ray, prepared) = Leaves::<T>::start(ray)?;
        if self.bvh.nodes.is_empty() {
            return None;
        }
        if O::ACTIVE {
            return self.watched::<false, O>(&ray, &prepared, observer);
        }
        let mut hit = RayHit::none();
        let found = self.bvh.ray_traverse(ray, &mut hit, |ray, index| self.leaves.test(ray, &prepared, index));
        self.leaves.hit(found, &hit)
    }

    #[inline]
    fn any_hit<O: Observer>(&self, ray: &Ray, observer: &mut O) -> bool {
        let Some((ray, prepared)) = Leaves::<T>::start(ray) else { return false };
        if self.bvh.nodes.is_empty() {
            return false;
        }
        if O::ACTIVE {
            return self.watched::<true, O>(&ray, &prepared, observer).is_some();
        }
        !self.bvh.ray_traverse_miss(ray, |ray, index| self.leaves.test(ray, &prepared, index))
    }

    fn footprint(&self) -> Footprint {
        let (triangles, references) = self.leaves.bytes();
        Footprint { nodes: size_of_val(&self.bvh.nodes[..]), references, triangles, other: 0 }
    }

    fn shape(&self) -> TreeShape {
        let mut shape = TreeShape { references: self.leaves.ids.len(), ..TreeShape::default() };
        let mut stack: Vec<(usize, usize)> = (!self.bvh.nodes.is_empty()).then_some((0, 0)).into_iter().collect();
        while let Some((at, depth)) = stack.pop() {
            let node = &self.bvh.nodes[at];
            shape.inner += 1;
            for child in 0..8 {
                if node.is_child_empty(child) {
                    continue;
                }
                if node.is_leaf(child) {
                    let (_, count) = node.child_primitives(child);
                    shape.leaves += 1;
                    shape.largest_leaf = shape.largest_leaf.max(count as usize);
                    shape.depth = shape.depth.max(depth + 1);
                } else {
                    stack.push((node.child_node_index(child) as usize, depth + 1));
                }
            }
        }
        shape
    }
}
