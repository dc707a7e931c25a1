use std::sync::Arc;
use std::time::Duration;

use obvhs::bvh2::Bvh2;
use obvhs::bvh2::builder::build_bvh2_from_tris;
use obvhs::ray::{Ray as PreparedRay, RayHit};

use super::{LeafTest, Leaves, ObvhsConfig, input};
use crate::accel::{Accel, BuildError, Footprint, Observer, TreeShape};
use crate::geometry::{Hit, Mesh, Ray};

/// The binary BVH of obvhs: PLOC with reinsertion, 48-byte nodes.
///
/// # References
/// Meister, Bittner: Parallel locally-ordered clustering for bounding volume hierarchy construction, 2018; Parallel
/// reinsertion for bounding volume hierarchy optimization, 2018.
pub struct ObvhsBvh2<T: LeafTest> {
    bvh: Bvh2,
    leaves: Leaves<T>,
}

impl<T: LeafTest> ObvhsBvh2<T> {
    /// The walk of obvhs over its public nodes, repeated here because its own cannot be watched. Gives the same hits, which
    /// a test holds; never timed.
    fn watched<const ANY: bool, O: Observer>(
        &self,
        ray: &PreparedRay,
        prepared: &T::Ray,
        observer: &mut O,
    ) -> Option<Hit> {
        let mut ray = *ray;
        let mut hit = RayHit::none();
        let nodes = &self.bvh.nodes;
        // The root is entered like a child of nothing; then pairs of children, each by the number of its first.
        let mut stack = vec![];
        let mut pair = vec![(0, nodes[0].aabb().intersect_ray(&ray))];
        loop {
            let waiting = stack.len();
            for (at, entry) in pair {
                let node = &nodes[at];
                if entry >= ray.tmax {
                    continue;
                }
                if !node.is_leaf() {
                    observer.inner();
                    stack.push(node.first_index as usize);
                    continue;
                }

                // Leaves are searched at once, also the farther one before what lies in the nearer inner node.
                observer.leaf(node.prim_count);
                for index in node.first_index..node.first_index + node.prim_count {
                    observer.test(1);
                    let t = self.leaves.test(&ray, prepared, index as usize);
                    if t < ray.tmax {
                        (hit.primitive_id, hit.t, ray.tmax) = (index, t, t);
                        if ANY {
                            return self.leaves.hit(true, &hit);
                        }
                    }
                }
            }

            // The nearer inner node is entered first.
            stack[waiting..].reverse();
            let Some(first) = stack.pop() else { break };
            let entry = |child: usize| (child, nodes[child].aabb().intersect_ray(&ray));
            let (a, b) = (entry(first), entry(first + 1));
            pair = if a.1 > b.1 { vec![b, a] } else { vec![a, b] };
        }
        self.leaves.hit(hit.t < f32::INFINITY, &hit)
    }
}

impl<T: LeafTest> Accel for ObvhsBvh2<T> {
    type Config = ObvhsConfig;

    const TRIANGLE_TEST: &'static str = T::NAME;

    fn build(mesh: &Arc<Mesh>, config: &ObvhsConfig) -> Result<Self, BuildError> {
        let (triangles, solid) = input(mesh);
        let bvh = build_bvh2_from_tris(&triangles, config.preset.params(), &mut Duration::default());
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
        let mut shape = TreeShape::default();
        let nodes = &self.bvh.nodes;
        let area = |at: usize| f64::from(nodes[at].aabb().half_area());
        let mut cost = 0.0;
        let mut stack: Vec<(usize, usize)> = (!nodes.is_empty()).then_some((0, 0)).into_iter().collect();
        while let Some((at, depth)) = stack.pop() {
            let node = &nodes[at];
            if node.is_leaf() {
                let count = node.prim_count as usize;
                shape.leaves += 1;
                shape.references += count;
                shape.largest_leaf = shape.largest_leaf.max(count);
                shape.depth = shape.depth.max(depth);
                cost += area(at) * TreeShape::leaf_cost(count);
            } else {
                shape.inner += 1;
                cost += area(at) * TreeShape::INNER_COST;
                let first = node.first_index as usize;
                stack.extend([(first, depth + 1), (first + 1, depth + 1)]);
            }
        }
        shape.sah_cost = nodes.first().map(|_| area(0)).filter(|&root| root > 0.0).map(|root| cost / root);
        shape
    }
}
