//! The traversal of a single ray, for both queries.
//!
//! **No hit is lost.** Let p be a point at which the ray hits a triangle. Let t* be the exact parameter of p.
//!
//! - The build rounds the boxes of clipped triangles outward. So the box of some leaf with this triangle contains p.
//! - The boxes of all nodes above this leaf contain p.
//! - Before a closest-hit query skips a box around p, the query has found a hit with a computed t below t* (see
//!   [`PreparedRay`]). `kdtree/traverse.rs` explains why this case is correct.
//! - Before an any-hit query skips a box around p, the query has found a hit.
//!
//! A closest-hit query visits children in the order that the node stores for the octant of the ray's direction. An
//! any-hit query visits child leaves before child nodes. Among leaves and among nodes, larger boxes come first, because
//! large boxes occlude most.
//!
//! # References
//! Nah, Manocha: SATO: Surface area traversal order for shadow ray tracing, 2014.

use super::node::Child;
use super::prepared_ray::PreparedRay;
use super::stack::{Entries, OnePage, Stack};
use super::tree::Bvh8;
use crate::accel::Observer;
use crate::geometry::{Hit, Ray};
use crate::simd::EightLanes;
use crate::traversal::leaf::{Nearest, search, start};
use crate::traversal::line::after;
use crate::traversal::walk::Walk;
use crate::triangle::TriangleTest;

impl<T: TriangleTest> Walk for Bvh8<T> {
    #[inline(always)]
    fn walk<const ANY: bool, L: EightLanes, O: Observer>(&self, ray: &Ray, observer: &mut O) -> Option<Hit> {
        let mut nearest = Nearest::NOTHING;
        self.find::<ANY, L, O>(ray, &mut nearest, observer);
        nearest.answer::<ANY>(ray)
    }
}

impl<T: TriangleTest> Bvh8<T> {
    #[inline(always)]
    pub(super) fn find<'a, const ANY: bool, L: EightLanes, O: Observer>(
        &'a self,
        ray: &Ray,
        nearest: &mut Nearest<T::Depth<'a>>,
        observer: &mut O,
    ) {
        let Some((t_min, unfound)) = start::<T>(ray) else { return *nearest = Nearest::NOTHING };
        *nearest = unfound;
        if self.root.is_leaf() {
            // The tree has no triangles.
            return;
        }
        let prepared_ray = PreparedRay::new(ray, self.farthest, t_min);
        let OnePage(_, entries) = &mut OnePage::new(Entries::new());
        // SAFETY: the contract of `Stack::of` allows the length 0 without further conditions.
        let mut stack = unsafe { Stack::<ANY>::of(entries, 0) };
        // SAFETY: the root is not a leaf, so the root is a node (invariants of `Bvh8`). No node has been entered yet.
        let first =
            unsafe { self.enter::<ANY, L, O>(self.root, &prepared_ray, after(nearest.t), &mut stack, observer) };
        // `T::prepare` is called only after the box tests, because many rays miss all children of the root.
        let Some(first) = first else { return };
        self.descend::<ANY, L, O>(first, &mut stack, &prepared_ray, &T::prepare(ray), nearest, observer);
    }

    /// # Safety
    /// `node` is a node of the tree. `node` has not been entered since the stack was empty.
    #[inline(always)]
    unsafe fn enter<const ANY: bool, L: EightLanes, O: Observer>(
        &self,
        node: Child,
        prepared_ray: &PreparedRay,
        end: f32,
        stack: &mut Stack<ANY>,
        observer: &mut O,
    ) -> Option<Child> {
        observer.inner();
        // SAFETY: by the contract of this function, `node` is a node of the tree. By this contract, `node` is pushed
        // once. No path has more than `DEPTH` nodes (invariants of `Bvh8`).
        unsafe {
            let node = self.nodes.get_unchecked(node.index());
            stack.push::<L>(node, prepared_ray.octant, prepared_ray.cross(node, end))
        }
    }

    /// Searches the subtree at `child`, then the subtrees on the stack.
    #[inline(always)]
    pub(super) fn descend<'a, const ANY: bool, L: EightLanes, O: Observer>(
        &'a self,
        mut child: Child,
        stack: &mut Stack<ANY>,
        prepared_ray: &PreparedRay,
        prepared: &T::Ray,
        nearest: &mut Nearest<T::Depth<'a>>,
        observer: &mut O,
    ) {
        let (t_min, mut end) = (prepared_ray.t_min, after(nearest.t));
        loop {
            let next = if let Some((first, count)) = child.blocks() {
                // SAFETY: a leaf refers to a range of `blocks` (invariants of `Bvh8`).
                let blocks = unsafe { self.blocks.get_unchecked(first..first + count) };
                // `search` needs the exact number of triangles only for an active observer.
                let mut held = u32::MAX;
                if O::ACTIVE {
                    held = blocks.iter().map(|block| block.len()).sum();
                    observer.leaf(held);
                }
                // `black_box` keeps the compiler from loading `prepared` before the loop. Many rays meet no leaf.
                let prepared = std::hint::black_box(prepared);
                search::<ANY, L, T, O>(blocks, held, prepared, t_min, nearest, &mut None, observer);
                if ANY && nearest.found() {
                    return;
                }
                end = after(nearest.t);
                None
            } else {
                // SAFETY: a child that is not a leaf is a node (invariants of `Bvh8`). Each child is entered once.
                unsafe { self.enter::<ANY, L, O>(child, prepared_ray, end, stack, observer) }
            };
            match next.or_else(|| stack.pop(end)) {
                Some(next) => child = next,
                None => return,
            }
        }
    }
}
