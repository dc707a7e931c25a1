//! One walk for both queries, in two flavours: plane intervals and child boxes.
//!
//! **No hit is lost.** Let a triangle be hit at the exact parameter t* in the interval, at the point p. Its references were
//! clipped outward, so some leaf whose closed cell contains p holds it. Both walks visit every leaf whose closed cell contains a
//! point of the ray in [t_min, nearest t]: a child is skipped only when its interval, moved outward by more than the rounding
//! of plane crossings (see [`Line`]), is empty or begins after the nearest hit so far. So the leaf of p is visited, unless a
//! hit with a computed t before t* has been found. Where t* exceeds a computed t of another triangle, that triangle is the
//! answer up to the error of the triangle test, which is not the traversal's. With the exact test nothing is computed: nearest t is
//! a float that is not before the nearest exact hit so far, so that the walk comes to every hit that is nearer or as near, and the
//! answer is the exact one with the lowest number.

use super::config::{Exit, Traversal};
use super::node::Node;
use super::{KdTree, WIDTH};
use crate::accel::Observer;
use crate::geometry::{Aabb, Hit, Ray};
use crate::simd::Sieve;
use crate::structures::leaf::{Mailbox, Nearest, search, start};
use crate::structures::line::{Line, after, before};
use crate::structures::walk::Walk;
use crate::triangle::TriangleTest;

/// More than the greatest depth of a tree.
const STACK: usize = 64;

/// One ray's search: what a walk needs of it.
struct Query<'a, const ANY: bool, T: TriangleTest, M, O> {
    tree: &'a KdTree<T>,
    line: Line,
    prepared: T::Ray,
    t_min: f32,
    nearest: Nearest<T::Depth>,
    mailbox: M,
    observer: &'a mut O,
}

impl<T: TriangleTest> Walk for KdTree<T> {
    #[inline(always)]
    fn walk<const ANY: bool, L: Sieve, O: Observer>(&self, ray: &Ray, observer: &mut O) -> Option<Hit> {
        if self.config.mailbox {
            self.walk_with::<ANY, L, [u32; 8], O>([u32::MAX; 8], ray, observer)
        } else {
            self.walk_with::<ANY, L, (), O>((), ray, observer)
        }
    }
}

impl<T: TriangleTest> KdTree<T> {
    #[inline(always)]
    fn walk_with<const ANY: bool, L: Sieve, M: Mailbox, O: Observer>(
        &self,
        mailbox: M,
        ray: &Ray,
        observer: &mut O,
    ) -> Option<Hit> {
        let (prepared, t_min, nearest) = start::<T>(ray)?;
        let line = Line::new(ray, &self.bounds);
        let mut query: Query<ANY, T, M, O> = Query { tree: self, line, prepared, t_min, nearest, mailbox, observer };
        match self.config.traversal {
            Traversal::PlaneIntervals => query.walk_intervals::<L>(),
            Traversal::ChildBoxes => query.walk_boxes::<L>(),
        }
        query.nearest.hit()
    }
}

impl<const ANY: bool, T: TriangleTest, M: Mailbox, O: Observer> Query<'_, ANY, T, M, O> {
    /// Searches a leaf. True when the ray is done.
    #[inline(always)]
    fn leaf<L: Sieve>(&mut self, node: Node) -> bool {
        self.observer.leaf(node.references());
        let blocks = self.tree.blocks_of(node);
        let count = node.references();
        let tests = search::<ANY, WIDTH, L, T, M>(
            blocks,
            count,
            &self.prepared,
            self.t_min,
            &mut self.nearest,
            &mut self.mailbox,
        );
        self.observer.test(tests);
        self.nearest.found() && (ANY || self.tree.config.exit == Exit::FirstLeaf)
    }

    #[inline(always)]
    fn walk_intervals<L: Sieve>(&mut self) {
        let nodes = &self.tree.nodes[..];
        let (t_min, t_max) = (before(self.t_min), after(self.nearest.t));
        let Some((mut t0, mut t1)) = self.line.clip(&self.tree.bounds, t_min, t_max) else { return };
        let mut stack = [(0, 0.0, 0.0); STACK];
        let mut top = 0;
        let mut at = 0;
        loop {
            let node = nodes[at as usize];
            if !node.is_leaf() {
                self.observer.inner();
                let axis = node.axis();
                let t = self.line.crossing(axis, node.split());
                let (first, second) =
                    if self.line.backward(axis) { (node.above(), at + 1) } else { (at + 1, node.above()) };

                // The ends of the interval have twice the slack of a crossing, so the crossing needs none here. Comparisons
                // with NaN are false: then both children get the whole interval.
                if t > t1 {
                    at = first;
                } else if t < t0 {
                    at = second;
                } else {
                    let (lower, upper) = (before(t), after(t));
                    stack[top] = (second, if lower > t0 { lower } else { t0 }, t1);
                    top += 1;
                    at = first;
                    t1 = if upper < t1 { upper } else { t1 };
                }
                continue;
            }

            if self.leaf::<L>(node) {
                return;
            }
            loop {
                if top == 0 {
                    return;
                }
                top -= 1;
                (at, t0, t1) = stack[top];
                if t0 <= self.nearest.t {
                    break;
                }
            }
        }
    }

    #[inline(always)]
    fn walk_boxes<L: Sieve>(&mut self) {
        let nodes = &self.tree.nodes[..];
        let Some((t0, _)) = self.line.clip(&self.tree.bounds, self.t_min, self.nearest.t) else { return };
        let mut stack = [(0, Aabb::EMPTY, 0.0); STACK];
        stack[0] = (0, self.tree.bounds, t0);
        let mut top = 1;
        while top > 0 {
            top -= 1;
            let (at, cell, t0) = stack[top];
            if t0 > self.nearest.t {
                continue;
            }
            let node = nodes[at as usize];
            if node.is_leaf() {
                if self.leaf::<L>(node) {
                    return;
                }
                continue;
            }

            // The child that is entered first comes off the stack first; of two entered at once, the one left first.
            self.observer.inner();
            let (below, above) = cell.cut(node.axis(), node.split());
            let in_below = self.line.clip(&below, self.t_min, self.nearest.t);
            let in_above = self.line.clip(&above, self.t_min, self.nearest.t);
            let mut push = |at, cell, t0| {
                stack[top] = (at, cell, t0);
                top += 1;
            };
            match (in_below, in_above) {
                (None, None) => {}
                (Some((t0, _)), None) => push(at + 1, below, t0),
                (None, Some((t0, _))) => push(node.above(), above, t0),
                (Some(b), Some(a)) if b.0 < a.0 || (b.0 == a.0 && b.1 <= a.1) => {
                    push(node.above(), above, a.0);
                    push(at + 1, below, b.0);
                }
                (Some(b), Some(a)) => {
                    push(at + 1, below, b.0);
                    push(node.above(), above, a.0);
                }
            }
        }
    }
}
