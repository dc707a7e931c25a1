//! The traversal of a single ray, for both queries.
//!
//! **No hit is lost.** Let the ray hit a triangle at the exact t* in its interval. Partitions round the boxes of
//! clipped parts outward, so some leaf has a reference to the triangle and a box that contains the hit point. The boxes
//! of all nodes above this leaf contain the point as well. The traversal enters all these boxes (see [`PreparedRay`])
//! or has already found a hit with a computed t before t*; `kdtree/traverse.rs` explains why this case is correct.
//!
//! The closest-hit query visits children from front to back, in an order stored for the octant of the direction. The
//! any-hit query visits lanes from the highest to the lowest: leaves before nodes and large boxes before small ones,
//! because large boxes occlude most (Nah, Manocha: SATO: Surface area traversal order for shadow ray tracing, 2014).

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
        // SAFETY: a stack of length 0 has no entries to read; `push` writes entries before it counts them.
        let mut stack = unsafe { Stack::<ANY>::of(entries, 0) };
        // SAFETY: a root that is not a leaf is a node (invariants of `Bvh8`), and the first node of every path.
        let first =
            unsafe { self.enter::<ANY, L, O>(self.root, &prepared_ray, after(nearest.t), &mut stack, observer) };
        // Prepare the ray for triangles only now, because many rays meet no box of the root.
        let Some(first) = first else { return };
        self.descend::<ANY, L, O>(first, &mut stack, &prepared_ray, &T::prepare(ray), nearest, observer);
    }

    /// Pushes the children whose boxes the ray enters at or before `end`, except the first child, which is returned.
    ///
    /// # Safety
    /// `node` is a node of the tree. No node of its path has been entered twice since the stack was empty.
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
        // SAFETY: a path has at most `DEPTH` nodes (invariants of `Bvh8`), and by contract each is pushed once.
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
                // SAFETY: a leaf names a range of `blocks` (invariants of `Bvh8`).
                let blocks = unsafe { self.blocks.get_unchecked(first..first + count) };
                // Counting triangles takes a loop over all lanes of the leaf, so only active observers pay for it.
                let mut held = u32::MAX;
                if O::ACTIVE {
                    held = blocks.iter().map(|block| block.len()).sum();
                    observer.leaf(held);
                }
                // Keeps the compiler from loading the prepared ray before the first node: many rays meet no leaf.
                let prepared = std::hint::black_box(prepared);
                search::<ANY, L, T, O>(blocks, held, prepared, t_min, nearest, &mut None, observer);
                if ANY && nearest.found() {
                    return;
                }
                end = after(nearest.t);
                None
            } else {
                // SAFETY: a child that is not a leaf names one of `nodes` (invariants of `Bvh8`). It is entered once.
                unsafe { self.enter::<ANY, L, O>(child, prepared_ray, end, stack, observer) }
            };
            match next.or_else(|| stack.pop(end)) {
                Some(next) => child = next,
                None => return,
            }
        }
    }
}
