//! The stack of a traversal.

use std::mem::MaybeUninit;

use super::node::{Child, DEPTH, Node, WIDTH};
use crate::simd::EightLanes;

/// Each node of a path leaves at most seven entries, and eight are written at once.
pub(super) const SIZE: usize = DEPTH * (WIDTH - 1) + WIDTH;
const _: () = assert!(1 + (DEPTH - 1) * (WIDTH - 1) + WIDTH <= SIZE);

/// Children to visit, the next one on top, and the parameters at which the ray enters them.
///
/// Eight entries are written at once, and a store across the border of two pages is slow. [`OnePage`] keeps the first
/// entries of a single ray in one page. Simultaneous stacks should begin at different offsets in their pages, to use
/// different sets of the cache.
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
/// registers, which lie at the start of a page.
#[repr(C, align(4096))]
pub(super) struct OnePage<T>(pub [MaybeUninit<u8>; BEFORE], pub T);

const BEFORE: usize = 1024;

/// The page contains the first entries of `enters`, more than most traversals use.
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
    /// - the length of the last stack of the same `ANY` over these entries, if no other code has written to the entries
    ///   since.
    #[inline(always)]
    pub unsafe fn of(entries: &'a mut Entries, len: usize) -> Self {
        Self { entries, len }
    }

    #[inline(always)]
    pub fn len(&self) -> usize {
        self.len
    }

    /// Pushes the children whose boxes the ray meets, except the first in visiting order. Returns the first child. With
    /// `ANY`, higher lanes come first.
    ///
    /// # Safety
    /// Each node of the path is pushed once, and the path has at most [`DEPTH`] nodes.
    #[inline(always)]
    pub unsafe fn push<L: EightLanes>(&mut self, node: &Node, octant: usize, (enter, leave): (L, L)) -> Option<Child> {
        let children = Child::bits(&node.children);
        let order = node.orders[octant & 7];
        // SAFETY: by the contract of this function, at most `DEPTH` - 1 nodes have left seven entries each. `reset` has
        // left at most one entry. By the assertion at `SIZE`, eight more fit. A child is a transparent `u32`.
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
                // Keeps the compiler from replacing the branches by a look-up, which is not predicted.
                std::hint::black_box(());
                let lane = if ANY { place } else { (order >> (3 * place) & 7) as usize };
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
            // SAFETY: by the contract of `of`, `push` has written the entries below `len`; with `ANY`, only `children`.
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
    /// Like [`push`](Self::push), but pushes the first child as well.
    ///
    /// # Safety
    /// As for [`push`](Self::push). In addition, [`pop_down`](Self::pop_down) is called before the next `push_all`.
    #[inline(always)]
    pub unsafe fn push_all<L: EightLanes>(&mut self, node: &Node, octant: usize, (enter, leave): (L, L)) {
        let children = Child::bits(&node.children);
        // SAFETY: as in `push`. A node leaves at most seven entries, because the caller pops one of the eight.
        let met = unsafe {
            let chosen = self.entries.children.as_mut_ptr().add(self.len).cast();
            let enters = self.entries.enters.as_mut_ptr().add(self.len).cast();
            enter.compress_ordered(leave, children, node.orders[octant & 7], enters, chosen)
        };
        self.len += met.count_ones() as usize;
    }

    /// Pops the next child that the ray enters at or before `end`, or [`BOTTOM`](Child::BOTTOM) if none is left.
    ///
    /// # Safety
    /// The entries were [`reset`](Entries::reset), and the bottom has not been returned since.
    #[inline(always)]
    pub unsafe fn pop_down(&mut self, end: f32) -> Child {
        // SAFETY: by the contracts of this function and `of`, the entries below `len` are written. The loop ends at the
        // bottom or above, because the bottom is entered at minus infinity.
        unsafe {
            self.len -= 1;
            while self.entries.enters.get_unchecked(self.len).assume_init() > end {
                self.len -= 1;
            }
            self.entries.children.get_unchecked(self.len).assume_init()
        }
    }
}
