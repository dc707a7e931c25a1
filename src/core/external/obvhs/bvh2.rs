use std::mem;
use std::time::Duration;

use obvhs::BvhBuildParams;
use obvhs::bvh2::Bvh2;
use obvhs::bvh2::builder::build_bvh2_from_tris;
use obvhs::bvh2::node::Bvh2Node;
use obvhs::fast_stack;
use obvhs::faststack::FastStack;
use obvhs::ray::{Ray as PreparedRay, RayHit};
use obvhs::triangle::Triangle;

use super::{Tree, aabb};
use crate::accel::{Observer, Part, TreeShape};

const _: () = assert!(size_of::<Bvh2Node>() == 32);

/// The builder is PLOC. All presets except `fastest` also use reinsertion. The feature `small_bvh2_node` of obvhs gives
/// nodes of 32 bytes.
///
/// # References
/// Meister, Bittner: Parallel locally-ordered clustering for bounding volume hierarchy construction, 2018; Parallel
/// reinsertion for bounding volume hierarchy optimization, 2018.
impl Tree for Bvh2 {
    type Node = Bvh2Node;

    fn build(triangles: &[Triangle], params: BvhBuildParams) -> Self {
        build_bvh2_from_tris(triangles, params, &mut Duration::default())
    }

    fn arrays(&mut self) -> (&mut Vec<Bvh2Node>, &mut Vec<u32>) {
        (&mut self.nodes, &mut self.primitive_indices)
    }

    fn leads_inside(&self, triangles: usize) -> bool {
        self.nodes.iter().all(|node| {
            let first = node.first_index as usize;
            if node.is_leaf() { first + node.prim_count as usize <= triangles } else { first + 1 < self.nodes.len() }
        })
    }

    /// Visits nodes in the same order as the traversal of obvhs.
    ///
    /// # Safety
    /// As for [`Tree::walk`].
    #[inline(always)]
    unsafe fn walk<const ANY: bool>(
        &self,
        ray: PreparedRay,
        test: impl FnMut(&PreparedRay, usize) -> f32,
        observer: &mut impl Observer,
    ) -> Option<RayHit> {
        fast_stack!(u32, (96, 192), self.max_depth, stack, {
            // SAFETY: `descend` has the same contract as this function.
            unsafe { descend::<ANY, _>(&self.nodes, &mut stack, ray, test, observer) }
        })
    }

    fn shape(&self) -> TreeShape {
        let root = self.nodes.first().map(|root| (0, aabb(*root.aabb())));
        TreeShape::of(root, |at: usize, _| {
            let node = &self.nodes[at];
            if node.is_leaf() {
                return Part::Leaf(node.prim_count as usize);
            }
            let first = node.first_index as usize;
            Part::Inner([first, first + 1].map(|child| (child, aabb(*self.nodes[child].aabb()))).into())
        })
    }
}

/// # Safety
/// As for [`Tree::walk`] on the tree that contains `nodes`.
#[inline(always)]
unsafe fn descend<const ANY: bool, O: Observer>(
    nodes: &[Bvh2Node],
    stack: &mut impl FastStack<u32>,
    mut ray: PreparedRay,
    mut test: impl FnMut(&PreparedRay, usize) -> f32,
    observer: &mut O,
) -> Option<RayHit> {
    let mut hit = RayHit::none();
    // Returns true if the traversal is finished.
    let mut leaf = |node: &Bvh2Node, ray: &mut PreparedRay, hit: &mut RayHit, observer: &mut O| {
        observer.leaf(node.prim_count);
        for index in node.first_index..node.first_index + node.prim_count {
            observer.test(1);
            let t = test(ray, index as usize);
            if t < ray.tmax {
                (hit.primitive_id, hit.t, ray.tmax) = (index, t, t);
                if ANY {
                    return true;
                }
            }
        }
        false
    };

    let root = nodes.first().filter(|root| root.aabb().intersect_ray(&ray) < ray.tmax)?;
    if root.is_leaf() {
        leaf(root, &mut ray, &mut hit, observer);
        return (hit.t < f32::INFINITY).then_some(hit);
    }
    observer.inner();
    let mut first = root.first_index;
    loop {
        // SAFETY: `first` and `first + 1` are the children of an inner node. The contract of this function guarantees
        // that all children exist.
        let [mut near, mut far] =
            unsafe { [nodes.get_unchecked(first as usize), nodes.get_unchecked(first as usize + 1)] };
        let (mut near_t, mut far_t) = (near.aabb().intersect_ray(&ray), far.aabb().intersect_ray(&ray));
        if near_t > far_t {
            mem::swap(&mut near_t, &mut far_t);
            mem::swap(&mut near, &mut far);
        }

        // A far leaf is searched before the subtree of a near inner node.
        let mut enters = |node: &Bvh2Node, t: f32, ray: &mut PreparedRay, observer: &mut O| {
            let meets = t < ray.tmax;
            if meets && node.is_leaf() {
                return (false, leaf(node, ray, &mut hit, observer));
            }
            if meets {
                observer.inner();
            }
            (meets, false)
        };
        let (enters_near, over) = enters(near, near_t, &mut ray, observer);
        if over {
            return Some(hit);
        }
        let (enters_far, over) = enters(far, far_t, &mut ray, observer);
        if over {
            return Some(hit);
        }

        first = match (enters_near, enters_far) {
            (true, true) => {
                stack.push(far.first_index);
                near.first_index
            }
            (true, false) => near.first_index,
            (false, true) => far.first_index,
            (false, false) => match stack.pop() {
                Some(waiting) => waiting,
                None => return (hit.t < f32::INFINITY).then_some(hit),
            },
        };
    }
}
