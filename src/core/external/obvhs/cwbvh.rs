use std::ops::Index;
use std::time::Duration;

use glam::UVec2;
use obvhs::BvhBuildParams;
use obvhs::cwbvh::CwBvh;
use obvhs::cwbvh::builder::build_cwbvh_from_tris;
use obvhs::cwbvh::node::CwBvhNode;
use obvhs::ray::{Ray as PreparedRay, RayHit};
use obvhs::traverse;
use obvhs::triangle::Triangle;

use super::{Tree, aabb};
use crate::accel::{Observer, Part, TreeShape};

/// A node of 80 bytes has up to eight children. A leaf has at most three triangles.
///
/// # References
/// Ylitie, Karras, Laine: Efficient incoherent ray traversal on GPUs through compressed wide BVHs. HPG 2017.
impl Tree for CwBvh {
    type Node = CwBvhNode;

    fn build(triangles: &[Triangle], params: BvhBuildParams) -> Self {
        build_cwbvh_from_tris(triangles, params, &mut Duration::default())
    }

    fn arrays(&mut self) -> (&mut Vec<CwBvhNode>, &mut Vec<u32>) {
        (&mut self.nodes, &mut self.primitive_indices)
    }

    /// For a leaf, `child_meta` contains the offset of the first triangle and one bit per triangle.
    fn leads_inside(&self, triangles: usize) -> bool {
        self.nodes.iter().all(|node| {
            (0..8).filter(|&child| !node.is_child_empty(child)).all(|child| {
                let (offset, bits) = (node.child_meta[child] & 31, node.child_meta[child] >> 5);
                if offset < 24 {
                    let end = u32::from(offset) + u8::BITS - bits.leading_zeros();
                    end <= 24 && node.primitive_base_idx as usize + end as usize <= triangles
                } else {
                    bits == 1 && (node.child_node_index(child) as usize) < self.nodes.len()
                }
            })
        })
    }

    /// Runs the macro `traverse!` of obvhs without bounds checks of nodes. The observer does not count leaves.
    ///
    /// # Safety
    /// As for [`Tree::walk`].
    #[inline(always)]
    unsafe fn walk<const ANY: bool>(
        &self,
        mut ray: PreparedRay,
        mut test: impl FnMut(&PreparedRay, usize) -> f32,
        observer: &mut impl Observer,
    ) -> Option<RayHit> {
        let mut hit = RayHit::none();
        let mut state = self.new_traversal(ray.direction);
        let mut node;
        // SAFETY: the traversal of an empty tree visits no node. Other traversals visit only the root and children. All
        // children exist by the contract of this function.
        let tree = unsafe { UncheckedTree::new(&self.nodes) };
        traverse!(
            tree,
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

    fn shape(&self) -> TreeShape {
        let root = (!self.nodes.is_empty()).then(|| (NodeOrLeaf::Node(0), aabb(self.total_aabb)));
        TreeShape::of(root, |place, _| match place {
            NodeOrLeaf::Leaf(count) => Part::Leaf(count as usize),
            NodeOrLeaf::Node(at) => {
                let node = &self.nodes[at];
                let place = |child| {
                    if node.is_leaf(child) {
                        NodeOrLeaf::Leaf(node.child_primitives(child).1)
                    } else {
                        NodeOrLeaf::Node(node.child_node_index(child) as usize)
                    }
                };
                let used = (0..8).filter(|&child| !node.is_child_empty(child));
                Part::Inner(used.map(|child| (place(child), aabb(node.child_aabb(child)))).collect())
            }
        })
    }
}

enum NodeOrLeaf {
    Node(usize),
    Leaf(u32),
}

/// The macro `traverse!` of obvhs receives this tree.
struct UncheckedTree<'a> {
    nodes: UncheckedNodes<'a>,
}

struct UncheckedNodes<'a>(&'a [CwBvhNode]);

impl<'a> UncheckedTree<'a> {
    /// # Safety
    /// Every index into the field `nodes` must be below the number of nodes.
    unsafe fn new(nodes: &'a [CwBvhNode]) -> Self {
        Self { nodes: UncheckedNodes(nodes) }
    }
}

impl Index<usize> for UncheckedNodes<'_> {
    type Output = CwBvhNode;

    #[inline(always)]
    fn index(&self, at: usize) -> &CwBvhNode {
        debug_assert!(at < self.0.len());
        // SAFETY: by the contract of `UncheckedTree::new`, `at` is below the number of nodes.
        unsafe { self.0.get_unchecked(at) }
    }
}
