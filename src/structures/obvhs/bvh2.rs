use std::time::Duration;

use obvhs::BvhBuildParams;
use obvhs::bvh2::Bvh2;
use obvhs::bvh2::builder::build_bvh2_from_tris;
use obvhs::ray::{Ray as PreparedRay, RayHit};
use obvhs::triangle::Triangle;

use super::{Tree, aabb};
use crate::accel::{Observer, Outline, Part};

/// Binary: PLOC with reinsertion, 48-byte nodes.
///
/// # References
/// Meister, Bittner: Parallel locally-ordered clustering for bounding volume hierarchy construction, 2018; Parallel
/// reinsertion for bounding volume hierarchy optimization, 2018.
impl Tree for Bvh2 {
    fn build(triangles: &[Triangle], params: BvhBuildParams) -> Self {
        build_bvh2_from_tris(triangles, params, &mut Duration::default())
    }

    fn order(&self) -> &[u32] {
        &self.primitive_indices
    }

    fn node_bytes(&self) -> usize {
        size_of_val(&self.nodes[..])
    }

    #[inline(always)]
    fn closest(&self, ray: PreparedRay, test: impl FnMut(&PreparedRay, usize) -> f32) -> Option<RayHit> {
        let mut hit = RayHit::none();
        self.ray_traverse(ray, &mut hit, test).then_some(hit)
    }

    #[inline(always)]
    fn any(&self, ray: PreparedRay, test: impl FnMut(&PreparedRay, usize) -> f32) -> bool {
        !self.ray_traverse_miss(ray, test)
    }

    /// The walk of obvhs over its public nodes, repeated here because its own cannot be watched. Gives the same hits, which
    /// a test holds; never timed.
    fn watched<const ANY: bool>(
        &self,
        ray: &PreparedRay,
        mut test: impl FnMut(&PreparedRay, usize) -> f32,
        observer: &mut impl Observer,
    ) -> Option<RayHit> {
        let mut ray = *ray;
        let mut hit = RayHit::none();
        let nodes = &self.nodes;
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
                    let t = test(&ray, index as usize);
                    if t < ray.tmax {
                        (hit.primitive_id, hit.t, ray.tmax) = (index, t, t);
                        if ANY {
                            return Some(hit);
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
        (hit.t < f32::INFINITY).then_some(hit)
    }

    fn outline(&self) -> Outline {
        let root = self.nodes.first().map(|root| (0, aabb(*root.aabb())));
        Outline::of(root, |at: usize, _, references| {
            let node = &self.nodes[at];
            if node.is_leaf() {
                references.extend(node.first_index..node.first_index + node.prim_count);
                return Part::Leaf;
            }
            let first = node.first_index as usize;
            Part::Inner([first, first + 1].map(|child| (child, aabb(*self.nodes[child].aabb()))).into())
        })
    }
}
