//! Interleaved closest-hit queries: several rays are active at once.
//!
//! Each ray takes the same steps as without interleaving. After a step of a ray, the memory for the next step of this
//! ray is prefetched. Rays at nodes and rays at leaves are in separate lists, to avoid branches on the child type.

use std::marker::PhantomData;
use std::mem::MaybeUninit;

use super::node::Child;
use super::prepared_ray::PreparedRay;
use super::stack::{Entries, Stack};
use super::tree::Bvh8;
use crate::geometry::{Hit, Ray};
use crate::simd::EightLanes;
use crate::traversal::leaf::{Nearest, search, start};
use crate::traversal::line::after;
use crate::traversal::pages;
use crate::triangle::TriangleTest;

/// Maximum number of active rays: enough to hide the latency of memory, few enough for the first-level cache.
const SLOTS: usize = 8;

struct StreamRay<'a, T: TriangleTest> {
    prepared_ray: PreparedRay,
    original: &'a Ray,
    ray: T::Ray,
    t_min: f32,
    nearest: Nearest<T::Depth<'a>>,
    /// Boxes that the ray enters after this parameter are skipped.
    end: f32,
    child: Child,
    /// The number that `done` receives with the hit.
    number: usize,
    entries: Entries,
    /// The length of the stack in `entries`.
    stack_len: usize,
}

pub(super) struct Slots<'a, T: TriangleTest>([MaybeUninit<StreamRay<'a, T>>; SLOTS]);

impl<T: TriangleTest> Slots<'_, T> {
    pub const EMPTY: Self = Self([const { MaybeUninit::uninit() }; SLOTS]);
}

struct List<'a, T: TriangleTest>([*mut StreamRay<'a, T>; SLOTS]);

impl<'a, T: TriangleTest> List<'a, T> {
    const EMPTY: Self = Self([std::ptr::null_mut(); SLOTS]);

    /// # Safety
    /// `i` is below [`SLOTS`].
    #[inline(always)]
    unsafe fn put(&mut self, i: usize, slot: *mut StreamRay<'a, T>) {
        debug_assert!(i < SLOTS);
        // SAFETY: by the contract of this function `i` is in bounds.
        unsafe { *self.0.get_unchecked_mut(i) = slot };
    }

    /// # Safety
    /// `i` is below [`SLOTS`].
    #[inline(always)]
    unsafe fn get(&self, i: usize) -> *mut StreamRay<'a, T> {
        debug_assert!(i < SLOTS);
        // SAFETY: by the contract of this function `i` is in bounds.
        unsafe { *self.0.get_unchecked(i) }
    }
}

/// Active rays in a tree. Each slot is counted in exactly one of the lists `nodes`, `leaves` and `free`.
pub(super) struct Stream<'a, T: TriangleTest> {
    tree: &'a Bvh8<T>,
    slots: PhantomData<&'a mut Slots<'a, T>>,
    nodes: List<'a, T>,
    leaves: List<'a, T>,
    free: List<'a, T>,
    /// The length of `nodes`.
    at_nodes: usize,
    /// The length of `leaves`.
    at_leaves: usize,
    /// The length of `free`.
    freed: usize,
}

impl<'a, T: TriangleTest> Stream<'a, T> {
    #[inline(always)]
    pub fn new(tree: &'a Bvh8<T>, slots: &'a mut Slots<'a, T>) -> Self {
        let mut free = List::EMPTY;
        for (place, slot) in free.0.iter_mut().zip(&mut slots.0) {
            *place = slot.as_mut_ptr();
        }
        let (nodes, leaves) = (List::EMPTY, List::EMPTY);
        Self { tree, slots: PhantomData, nodes, leaves, free, at_nodes: 0, at_leaves: 0, freed: SLOTS }
    }

    #[inline(always)]
    pub fn run<L: EightLanes>(
        &mut self,
        mut rays: impl Iterator<Item = (usize, &'a Ray)>,
        mut done: impl FnMut(usize, Option<Hit>),
    ) {
        loop {
            while self.freed > 0 {
                let Some((number, ray)) = rays.next() else { break };
                self.push::<L>(number, ray, &mut done);
            }
            if self.freed == SLOTS {
                return;
            }
            self.round::<L>(&mut done);
        }
    }

    /// A slot must be free.
    #[inline(always)]
    fn push<L: EightLanes>(&mut self, number: usize, ray: &'a Ray, done: &mut impl FnMut(usize, Option<Hit>)) {
        let (tree, root) = (self.tree, self.tree.root);
        let Some((t_min, nearest)) = start::<T>(ray).filter(|_| !root.is_leaf()) else { return done(number, None) };
        let (prepared_ray, end) = (PreparedRay::new(ray, tree.farthest, t_min), after(nearest.t));
        // SAFETY: by the contract of this function `freed` is above 0. `free` contains `freed` slots. `new` has
        // borrowed all slots for the lifetime of the stream. Every field of the slot is written before the slot is put
        // into a list. Unwritten entries lie at or above `stack_len`. A slot is counted in one list at a time, so no
        // list becomes longer than `SLOTS`. The root is not a leaf, so the root is a node (invariants of `Bvh8`). The
        // root is the first node of every path.
        unsafe {
            let slot = self.free.get(self.freed - 1);
            Entries::reset(&raw mut (*slot).entries);
            let mut stack = Stack::<false>::of(&mut (*slot).entries, 1);
            let node = tree.nodes.get_unchecked(root.index());
            stack.push_all::<L>(node, prepared_ray.octant, prepared_ray.cross(node, end));
            let child = stack.pop_down(end);
            let stack_len = stack.len();
            if child == Child::BOTTOM {
                return done(number, None);
            }
            tree.fetch(child);
            self.freed -= 1;
            (&raw mut (*slot).prepared_ray).write(prepared_ray);
            (&raw mut (*slot).original).write(ray);
            (&raw mut (*slot).ray).write(T::prepare(ray));
            (&raw mut (*slot).t_min).write(t_min);
            (&raw mut (*slot).end).write(end);
            (&raw mut (*slot).nearest).write(nearest);
            (&raw mut (*slot).child).write(child);
            (&raw mut (*slot).number).write(number);
            (&raw mut (*slot).stack_len).write(stack_len);
            self.nodes.put(self.at_nodes, slot);
            self.leaves.put(self.at_leaves, slot);
            self.at_nodes += usize::from(!child.is_leaf());
            self.at_leaves += usize::from(child.is_leaf());
        }
    }

    #[inline(always)]
    fn round<L: EightLanes>(&mut self, done: &mut impl FnMut(usize, Option<Hit>)) {
        let tree = self.tree;
        // Each list is rewritten in place while it is read. Each slot is written to both lists. Only one list counts
        // the slot.
        let (mut nodes, rays) = (0, self.at_nodes);
        for k in 0..rays {
            // SAFETY: the first `at_nodes` elements of `nodes` are filled. Each slot is counted in one list, so `at` is
            // the only reference to the slot. No list becomes longer than `SLOTS`. The child of the slot is a node, so
            // `pop_down` has not returned `BOTTOM`. A path has at most `DEPTH` nodes (invariants of `Bvh8`).
            unsafe {
                let slot = self.nodes.get(k);
                let at = &mut *slot;
                let node = tree.nodes.get_unchecked(at.child.index());
                let mut stack = Stack::<false>::of(&mut at.entries, at.stack_len);
                stack.push_all::<L>(node, at.prepared_ray.octant, at.prepared_ray.cross(node, at.end));
                at.child = stack.pop_down(at.end);
                at.stack_len = stack.len();
                tree.fetch(at.child);
                self.nodes.put(nodes, slot);
                self.leaves.put(self.at_leaves + k - nodes, slot);
                nodes += usize::from(!at.child.is_leaf());
            }
        }
        let (mut leaves, rays) = (0, self.at_leaves + rays - nodes);
        for k in 0..rays {
            // SAFETY: as in the loop over `nodes`. The child is a leaf. A leaf other than `Child::BOTTOM` is a range of
            // `blocks` (invariants of `Bvh8`). If the child is `BOTTOM`, the slot is freed. `push` resets the stack of
            // a free slot before the next use.
            unsafe {
                let slot = self.leaves.get(k);
                let at = &mut *slot;
                if at.child != Child::BOTTOM {
                    let (first, count) = at.child.leaf_blocks();
                    let blocks = tree.blocks.get_unchecked(first..first + count);
                    let (ray, nearest) = (&at.ray, &mut at.nearest);
                    search::<false, L, T, ()>(blocks, u32::MAX, ray, at.t_min, nearest, &mut None, &mut ());
                    at.end = after(at.nearest.t);
                    let mut stack = Stack::<false>::of(&mut at.entries, at.stack_len);
                    at.child = stack.pop_down(at.end);
                    at.stack_len = stack.len();
                    tree.fetch(at.child);
                    self.nodes.put(nodes, slot);
                    self.leaves.put(leaves, slot);
                    nodes += usize::from(!at.child.is_leaf());
                    leaves += usize::from(at.child.is_leaf());
                    continue;
                }
                done(at.number, at.nearest.answer::<false>(at.original));
                self.free.put(self.freed, slot);
                self.freed += 1;
            }
        }
        (self.at_nodes, self.at_leaves) = (nodes, leaves);
    }
}

impl<T: TriangleTest> Bvh8<T> {
    #[inline(always)]
    fn fetch(&self, child: Child) {
        let node = self.nodes.as_ptr().wrapping_add(child.index()).cast::<u8>();
        let block = self.blocks.as_ptr().wrapping_add(child.leaf_blocks().0).cast::<u8>();
        let first = std::hint::select_unpredictable(child.is_leaf(), block, node);
        (0..4).for_each(|line| pages::fetch(first.wrapping_add(64 * line)));
    }
}
