//! Traverses KD-trees for closest hit and any hit, by plane intervals or by child boxes.
//!
//! **No hit is lost**, except with [`Exit::FirstLeaf`]. Let p be the point of a hit on a triangle.
//!
//! - The build clips references outward or not at all. So at least one leaf references the triangle and has p in its
//!   closed cell.
//! - A child is skipped only if the ray's interval in this child is empty or begins after the nearest known hit.
//! - If the child of p is skipped, the known hit is nearer, except for the error of its triangle test. The exact test
//!   has no such error: the known `t` is never below the exact `t` of the known hit.
//! - The ray's interval in a child includes slack for the rounding of plane crossings (see [`Line`]).
//! - A plane crossing may overflow to infinity. For plane intervals, [`finite_entry`] makes an infinite entry finite.
//!   For child boxes, [`open_end`] moves an end near the largest float to infinity.
//! - With the exact triangle test, closest hit returns the nearest hit. At equal `t`, the lowest triangle number wins.

use std::mem::MaybeUninit;

use super::config::{Exit, Traversal};
use super::node::Node;
use super::tree::KdTree;
use crate::accel::Observer;
use crate::build::cells::DEEPEST;
use crate::geometry::{Aabb, Hit, Ray};
use crate::simd::EightLanes;
use crate::traversal::leaf::{Mailbox, search, start};
use crate::traversal::line::{Line, after, before, finite_entry, open_end};
use crate::traversal::walk::Walk;
use crate::triangle::TriangleTest;

/// The stack contains at most `DEEPEST + 1` nodes, because no node is deeper than [`DEEPEST`].
const STACK: usize = 64;
const _: () = assert!(STACK > DEEPEST as usize);

impl<T: TriangleTest> Walk for KdTree<T> {
    #[inline(always)]
    fn walk<const ANY: bool, L: EightLanes, O: Observer>(&self, ray: &Ray, observer: &mut O) -> Option<Hit> {
        let (t_min, mut nearest) = start::<T>(ray)?;
        let prepared = T::prepare(ray);
        let line = Line::new(ray, &self.bounds);
        let mut mailbox = self.config.mailbox.then_some(Mailbox::EMPTY);
        let mut leaves = Leaves::enter(self, &line, t_min, nearest.t)?;
        while let Some(leaf) = leaves.next(self, &line, t_min, nearest.t, observer) {
            let (blocks, count) = (self.blocks_of(leaf), leaf.references());
            observer.leaf(count);
            search::<ANY, L, T, O>(blocks, count, &prepared, t_min, &mut nearest, &mut mailbox, observer);
            if nearest.found() && (ANY || self.config.exit == Exit::FirstLeaf) {
                break;
            }
        }
        nearest.answer::<ANY>(ray)
    }
}

#[expect(clippy::large_enum_variant, reason = "one for each walk, on the stack, with entries that are not initialised")]
enum Leaves {
    Intervals(Stack<(u32, f32, f32)>),
    Boxes(Stack<(u32, Aabb, f32)>),
}

/// To save time, only the first `len` entries are initialised.
struct Stack<E> {
    entries: [MaybeUninit<E>; STACK],
    len: usize,
}

impl<E: Copy> Stack<E> {
    #[inline(always)]
    fn with(root: E) -> Self {
        let mut stack = Self { entries: [const { MaybeUninit::uninit() }; STACK], len: 0 };
        stack.push(root);
        stack
    }

    #[inline(always)]
    fn push(&mut self, entry: E) {
        self.entries[self.len].write(entry);
        self.len += 1;
    }

    #[inline(always)]
    fn pop(&mut self) -> Option<E> {
        self.len = self.len.checked_sub(1)?;
        // SAFETY: `push` has initialised every entry below the old `len`.
        Some(unsafe { self.entries[self.len].assume_init() })
    }
}

impl Leaves {
    #[inline(always)]
    fn enter<T: TriangleTest>(tree: &KdTree<T>, line: &Line, t_min: f32, t_max: f32) -> Option<Self> {
        Some(match tree.config.traversal {
            Traversal::PlaneIntervals => {
                // The interval needs no slack before 0, because rounding never makes a positive crossing negative.
                let (t0, t1) = line.clip(&tree.bounds, before(t_min).max(0.0), after(t_max))?;
                Self::Intervals(Stack::with((0, t0, t1)))
            }
            Traversal::ChildBoxes => {
                let (t0, _) = line.clip(&tree.bounds, t_min, open_end(t_max))?;
                Self::Boxes(Stack::with((0, tree.bounds, t0)))
            }
        })
    }

    /// `end` is the `t` of the nearest hit so far, or the end of the ray.
    #[inline(always)]
    fn next<T: TriangleTest, O: Observer>(
        &mut self,
        tree: &KdTree<T>,
        line: &Line,
        t_min: f32,
        end: f32,
        observer: &mut O,
    ) -> Option<Node> {
        match self {
            Self::Intervals(stack) => by_intervals(stack, &tree.nodes, line, end, observer),
            Self::Boxes(stack) => by_boxes(stack, &tree.nodes, line, t_min, open_end(end), observer),
        }
    }
}

#[inline(always)]
fn by_intervals<O: Observer>(
    stack: &mut Stack<(u32, f32, f32)>,
    nodes: &[Node],
    line: &Line,
    end: f32,
    observer: &mut O,
) -> Option<Node> {
    let (mut at, t0, mut t1) = loop {
        let (at, t0, t1) = stack.pop()?;
        let t0 = finite_entry(t0);
        if t0 <= end {
            break (at, t0, t1);
        }
    };
    loop {
        let node = nodes[at as usize];
        if node.is_leaf() {
            return Some(node);
        }
        observer.inner();
        let axis = node.axis();
        let t = line.crossing(axis, node.split());
        let (first, second) = if line.backward(axis) { (node.above(), at + 1) } else { (at + 1, node.above()) };

        // The comparisons of `t` with `t1` and `t0` need no slack, because `t0` and `t1` are moved outward by more than
        // twice the error of a crossing. If `t` is NaN, both children get the whole interval.
        if t > t1 {
            at = first;
        } else if t < t0 {
            at = second;
        } else {
            let (lower, upper) = (before(t), after(t));
            stack.push((second, if lower > t0 { lower } else { t0 }, t1));
            at = first;
            t1 = if upper < t1 { upper } else { t1 };
        }
    }
}

/// `end` must be a result of [`open_end`].
#[inline(always)]
fn by_boxes<O: Observer>(
    stack: &mut Stack<(u32, Aabb, f32)>,
    nodes: &[Node],
    line: &Line,
    t_min: f32,
    end: f32,
    observer: &mut O,
) -> Option<Node> {
    loop {
        let (at, cell, t0) = stack.pop()?;
        if t0 > end {
            continue;
        }
        let node = nodes[at as usize];
        if node.is_leaf() {
            return Some(node);
        }

        // First visit the child with the smaller entry `t`. If the entries are equal, first visit the child with the
        // smaller exit `t`.
        observer.inner();
        let (below, above) = cell.cut(node.axis(), node.split());
        let (in_below, in_above) = (line.clip(&below, t_min, end), line.clip(&above, t_min, end));
        match (in_below, in_above) {
            (None, None) => {}
            (Some((t0, _)), None) => stack.push((at + 1, below, t0)),
            (None, Some((t0, _))) => stack.push((node.above(), above, t0)),
            (Some(b), Some(a)) if b.0 < a.0 || (b.0 == a.0 && b.1 <= a.1) => {
                stack.push((node.above(), above, a.0));
                stack.push((at + 1, below, b.0));
            }
            (Some(b), Some(a)) => {
                stack.push((at + 1, below, b.0));
                stack.push((node.above(), above, a.0));
            }
        }
    }
}
