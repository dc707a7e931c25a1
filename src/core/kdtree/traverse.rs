//! One traversal for closest hit and any hit, in two variants: plane intervals and child boxes.
//!
//! **No hit is lost.** Let a ray hit a triangle at the point p and the exact parameter t* in its interval.
//!
//! - The build clips references outward or not at all. So some leaf whose closed cell contains p references the
//!   triangle.
//! - Both variants skip a child only if its interval is empty or begins after the nearest hit so far. Before this test,
//!   they move the interval outward by more than the rounding error of plane crossings (see [`Line`]).
//! - If the crossing at which an interval begins overflows, plane intervals replace the crossing by a finite number.
//!   Child boxes replace the end of the search by infinity if a crossing before this end may overflow.
//! - So both variants visit the leaf of p, or have found another hit with a computed t before t*. The other hit is
//!   nearer, or farther by at most the error of its triangle test.
//! - With the exact test, the computed t of a hit is never below its exact t. So the result is the nearest hit and,
//!   among equally near hits, the hit with the lowest number.
//!
//! Only [`Exit::FirstLeaf`] may lose nearer hits.

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

/// The stack contains at most one node per level, and two of the lowest level. No level exceeds [`DEEPEST`].
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

/// The entries are uninitialised, because initialising them takes as long as a short traversal.
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
        // SAFETY: `push` writes an entry before it counts it, and the popped entry was below the old length.
        Some(unsafe { self.entries[self.len].assume_init() })
    }
}

impl Leaves {
    #[inline(always)]
    fn enter<T: TriangleTest>(tree: &KdTree<T>, line: &Line, t_min: f32, t_max: f32) -> Option<Self> {
        Some(match tree.config.traversal {
            Traversal::PlaneIntervals => {
                // The interval needs no slack before 0, because a computed exit is negative only if the exact exit is.
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

        // The ends of the interval are moved outward by more than twice the error of a crossing. So the crossing needs
        // no slack here. If the crossing is NaN, both comparisons are false and both children get the whole interval.
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

/// `end` is a result of [`open_end`].
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

        // First visit the child that the ray enters first. If the ray enters both children at once, first visit the
        // child that it leaves first.
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
