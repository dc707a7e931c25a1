use std::time::Duration;

use glam::UVec2;
use obvhs::BvhBuildParams;
use obvhs::cwbvh::CwBvh;
use obvhs::cwbvh::builder::build_cwbvh_from_tris;
use obvhs::ray::{Ray as PreparedRay, RayHit};
use obvhs::traverse;
use obvhs::triangle::Triangle;

use super::{Tree, aabb};
use crate::accel::{Observer, Outline, Part};

/// Compressed, 8 wide: 80-byte nodes, at most three triangles a leaf.
///
/// # References
/// Ylitie, Karras, Laine: Efficient incoherent ray traversal on GPUs through compressed wide BVHs. HPG 2017.
impl Tree for CwBvh {
    fn build(triangles: &[Triangle], params: BvhBuildParams) -> Self {
        build_cwbvh_from_tris(triangles, params, &mut Duration::default())
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

    /// The walk of obvhs through its own macro. A group of triangles that a node hands over counts as no node of its own, so
    /// only inner nodes are steps.
    fn watched<const ANY: bool>(
        &self,
        ray: &PreparedRay,
        mut test: impl FnMut(&PreparedRay, usize) -> f32,
        observer: &mut impl Observer,
    ) -> Option<RayHit> {
        let mut ray = *ray;
        let mut hit = RayHit::none();
        let mut state = self.new_traversal(ray.direction);
        let mut node;
        traverse!(
            self,
            node,
            state,
            {
                observer.inner();
                node.intersect_ray(&ray, state.oct_inv4)
            },
            {
                observer.test(1);
                let t = test(&ray, state.primitive_id as usize);
                if t < ray.tmax {
                    (hit.primitive_id, hit.t, ray.tmax) = (state.primitive_id, t, t);
                    if ANY {
                        return Some(hit);
                    }
                }
            }
        );
        (hit.t < f32::INFINITY).then_some(hit)
    }

    /// Children of a node that hold triangles are its leaves; their boxes are rounded outward to a grid of 256 cells.
    fn outline(&self) -> Outline {
        let root = (!self.nodes.is_empty()).then(|| (Place::Node(0), aabb(self.total_aabb)));
        Outline::of(root, |place, _, references| match place {
            Place::Leaf(first, count) => {
                references.extend(first..first + count);
                Part::Leaf
            }
            Place::Node(at) => {
                let node = &self.nodes[at];
                let place = |child| {
                    let (first, count) = node.child_primitives(child);
                    if node.is_leaf(child) {
                        Place::Leaf(first, count)
                    } else {
                        Place::Node(node.child_node_index(child) as usize)
                    }
                };
                let used = (0..8).filter(|&child| !node.is_child_empty(child));
                Part::Inner(used.map(|child| (place(child), aabb(node.child_aabb(child)))).collect())
            }
        })
    }
}

/// A node, or a child of one that holds triangles: the first of them and how many there are.
enum Place {
    Node(usize),
    Leaf(u32, u32),
}
