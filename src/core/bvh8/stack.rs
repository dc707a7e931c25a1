//! The stack of a traversal.

use std::mem::MaybeUninit;

use super::node::{Child, DEPTH, Node, WIDTH};
use crate::simd::EightLanes;

/// At most seven entries remain per node of a path. A push writes eight entries at once.
pub(super) const SIZE: usize = DEPTH * (WIDTH - 1) + WIDTH;
const _: () = assert!(1 + (DEPTH - 1) * (WIDTH - 1) + WIDTH <= SIZE);

/// The children to visit, with the parameter at which the ray enters each child. The next child is on top.
///
/// A store of eight entries across a page border is slow. [`OnePage`] keeps the first entries in one page. Stacks of
/// interleaved rays should begin at different page offsets, to use different cache sets.
#[repr(C)]
pub(super) struct Entries {
    children: [MaybeUninit<Child>; SIZE],
    enters: [MaybeUninit<f32>; SIZE],
}

pub(super) struct Stack<'a, const ANY: bool> {
    entries: &'a mut Entries,
    len: usize,
}

/// A value that begins a quarter of a page after the start of a page. The offset avoids 4K aliasing with spilled
/// registers at the start of a page.
#[repr(C, align(4096))]
pub(super) struct OnePage<T>(pub [MaybeUninit<u8>; BEFORE], pub T);

const BEFORE: usize = 1024;

/// The page contains more than 50 entries of `enters`. Most traversals use fewer entries.
const _: () = assert!((4096 - BEFORE) / size_of::<Child>() - SIZE > 50);

impl<T> OnePage<T> {
    #[inline(always)]
    pub fn new(value: T) -> Self {
        Self([const { MaybeUninit::uninit() }; BEFORE], value)
    }
}

impl Entries {
    #[inline(always)]
    pub fn new() -> Self {
        Self { children: [const { MaybeUninit::uninit() }; SIZE], enters: [const { MaybeUninit::uninit() }; SIZE] }
    }

    /// # Safety
    /// `entries` is valid for writes.
    #[inline(always)]
    pub unsafe fn reset(entries: *mut Self) {
        // SAFETY: by the contract of this function `entries` is valid for writes.
        unsafe {
            (&raw mut (*entries).children[0]).write(MaybeUninit::new(Child::BOTTOM));
            (&raw mut (*entries).enters[0]).write(MaybeUninit::new(f32::NEG_INFINITY));
        }
    }
}

impl<'a, const ANY: bool> Stack<'a, ANY> {
    /// # Safety
    /// `len` is one of:
    /// - 0;
    /// - 1, after [`reset`](Entries::reset);
    /// - the final length of the previous stack with the same `ANY` over `entries`. No other code has written to
    ///   `entries` since.
    #[inline(always)]
    pub unsafe fn of(entries: &'a mut Entries, len: usize) -> Self {
        Self { entries, len }
    }

    #[inline(always)]
    pub fn len(&self) -> usize {
        self.len
    }

    /// Returns the first child, in visiting order, whose box the ray meets. Pushes all later children whose boxes the
    /// ray meets. With `ANY`, children are visited from the highest lane to the lowest lane.
    ///
    /// # Safety
    /// Each node of the path is pushed once. The path has at most [`DEPTH`] nodes.
    #[inline(always)]
    pub unsafe fn push<L: EightLanes>(&mut self, node: &Node, octant: usize, (enter, leave): (L, L)) -> Option<Child> {
        let children = Child::bits(&node.children);
        let order = node.orders[octant & 7];
        // SAFETY: by the contract of this function, at most `DEPTH` - 1 nodes were pushed before. Each of these nodes
        // added at most seven entries. `reset` added at most one entry. By the assertion at `SIZE`, eight more entries
        // fit. `Child` has the layout of `u32`.
        let met = unsafe {
            let chosen = self.entries.children.as_mut_ptr().add(self.len).cast();
            if ANY {
                enter.compress(leave, children, chosen)
            } else {
                enter.compress_ordered(
                    leave,
                    children,
                    order,
                    self.entries.enters.as_mut_ptr().add(self.len).cast(),
                    chosen,
                )
            }
        };
        for place in (0..WIDTH).rev() {
            if met >> place != 0 {
                self.len += met.count_ones() as usize - 1;
                // Keeps the compiler from replacing the predicted branches by a look-up.
                std::hint::black_box(());
                let lane = if ANY { place } else { (order >> (3 * place) & 7) as usize };
                // Reading the child from the node is faster than reading back the entry just written.
                return Some(node.children[lane]);
            }
        }
        None
    }

    /// With `ANY`, `end` has no effect.
    #[inline(always)]
    pub fn pop(&mut self, end: f32) -> Option<Child> {
        while self.len > 0 {
            self.len -= 1;
            // SAFETY: by the contract of `of`, the entries below `len` are written. With `ANY`, only `children` is
            // read.
            unsafe {
                if ANY || self.entries.enters.get_unchecked(self.len).assume_init() <= end {
                    return Some(self.entries.children.get_unchecked(self.len).assume_init());
                }
            }
        }
        None
    }
}

impl Stack<'_, false> {
    /// Like [`push`](Self::push), but also pushes the first child.
    ///
    /// # Safety
    /// As for [`push`](Self::push). In addition, [`pop_down`](Self::pop_down) is called before the next `push_all`.
    #[inline(always)]
    pub unsafe fn push_all<L: EightLanes>(&mut self, node: &Node, octant: usize, (enter, leave): (L, L)) {
        let children = Child::bits(&node.children);
        // SAFETY: as in `push`. At most seven entries remain per node, because the caller pops one of eight entries.
        let met = unsafe {
            let chosen = self.entries.children.as_mut_ptr().add(self.len).cast();
            let enters = self.entries.enters.as_mut_ptr().add(self.len).cast();
            enter.compress_ordered(leave, children, node.orders[octant & 7], enters, chosen)
        };
        self.len += met.count_ones() as usize;
    }

    /// Pops the next child that the ray enters at or before `end`, or [`BOTTOM`](Child::BOTTOM).
    ///
    /// # Safety
    /// The entries were [`reset`](Entries::reset). [`BOTTOM`](Child::BOTTOM) has not been returned since the reset.
    #[inline(always)]
    pub unsafe fn pop_down(&mut self, end: f32) -> Child {
        // SAFETY: by the contracts of this function and `of`, the entries below `len` are written. `BOTTOM` ends the
        // loop, because its entry parameter is minus infinity.
        unsafe {
            self.len -= 1;
            while self.entries.enters.get_unchecked(self.len).assume_init() > end {
                self.len -= 1;
            }
            self.entries.children.get_unchecked(self.len).assume_init()
        }
    }
}
