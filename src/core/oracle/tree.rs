//! A bounding volume hierarchy that loses no hit.
//!
//! # No hit is lost
//! Minima and maxima of `f32` are exact. Hence the box of a node contains the triangles of the node.
//!
//! Let a ray hit a triangle of a node at the exact `t`. On one axis, let the box of the node reach from `low` to
//! `high`. Let `o` and `d` be the components of the origin and the direction on this axis. If `d` is 0, `o` is between
//! `low` and `high`. Otherwise `t` is between `(low - o) / d` and `(high - o) / d`. In `f64`, each quotient has two
//! roundings. A nonzero quotient has a magnitude between 2^-277 and 2^278, so no quotient overflows or underflows.
//! [`Span::outward`] moves each quotient outward by at least the rounding error.
//!
//! A node is skipped only if the intervals of the three axes and [`t_min`, `bound`] have no common `t`. The bound is
//! never less than the exact `t` of the nearest hit so far.

use super::filter::Span;
use crate::geometry::{Aabb, Mesh, Ray};

/// A binary BVH.
pub struct Tree {
    nodes: Vec<Node>,
    ids: Vec<u32>,
}

struct Node {
    bounds: Aabb,
    kind: NodeKind,
}

enum NodeKind {
    /// The first child follows its parent in `nodes`.
    Inner {
        second: u32,
    },
    Leaf {
        first: u32,
        count: u32,
    },
}

const LEAF: usize = 4;

/// The stack holds at most one node for each inner node on a path from the root. A path has at most 28 inner nodes,
/// because a mesh has at most 2^30 triangles and each child has half of them. A leaf holds up to `LEAF` triangles.
const STACK: usize = 32;

impl Tree {
    pub fn new(mesh: &Mesh) -> Self {
        let mut boxes: Vec<(u32, Aabb)> = mesh.solid().map(|id| (id, mesh.triangle_bounds(id))).collect();
        let mut tree = Self { nodes: vec![], ids: Vec::with_capacity(boxes.len()) };
        if !boxes.is_empty() {
            tree.grow(&mut boxes);
        }
        tree
    }

    fn grow(&mut self, boxes: &mut [(u32, Aabb)]) {
        let bounds = boxes.iter().fold(Aabb::EMPTY, |sum, (_, b)| sum.union(*b));
        let index = self.nodes.len();
        let leaf = NodeKind::Leaf { first: self.ids.len() as u32, count: boxes.len() as u32 };
        self.nodes.push(Node { bounds, kind: leaf });
        if boxes.len() <= LEAF {
            self.ids.extend(boxes.iter().map(|(id, _)| *id));
            return;
        }
        // The choice of the split does not change the hits.
        let middle = |b: &Aabb| b.min * 0.5 + b.max * 0.5;
        let axis = Aabb::of_points(boxes.iter().map(|(_, b)| middle(b))).longest_axis();
        let half = boxes.len() / 2;
        boxes.select_nth_unstable_by(half, |(_, a), (_, b)| middle(a)[axis].total_cmp(&middle(b)[axis]));
        let (first, second) = boxes.split_at_mut(half);
        self.grow(first);
        self.nodes[index].kind = NodeKind::Inner { second: self.nodes.len() as u32 };
        self.grow(second);
    }

    /// Calls `test` for every triangle that `ray` hits at a `t` of at most `bound`. Other triangles may also be tested.
    /// `ray` must be valid.
    ///
    /// The result of `test` replaces `bound`. Triangles that are hit only beyond the new `bound` may be left out.
    pub fn visit(&self, ray: &Ray, mut bound: f64, mut test: impl FnMut(u32) -> f64) {
        let enter = |index: u32, bound: f64| Some((index, near(ray, &self.nodes.get(index as usize)?.bounds, bound)?));
        let mut stack = [(0, 0.0); STACK];
        let mut waiting = 0;
        let mut next = enter(0, bound);
        loop {
            let Some((index, near)) = next.take().or_else(|| {
                waiting = usize::checked_sub(waiting, 1)?;
                Some(stack[waiting])
            }) else {
                return;
            };
            // The bound may have decreased since the node was pushed.
            if near > bound {
                continue;
            }
            match self.nodes[index as usize].kind {
                NodeKind::Leaf { first, count } => {
                    for id in &self.ids[first as usize..][..count as usize] {
                        bound = test(*id);
                    }
                }
                NodeKind::Inner { second } => {
                    next = match (enter(index + 1, bound), enter(second, bound)) {
                        (Some(a), Some(b)) => {
                            let (near, far) = if b.1 < a.1 { (b, a) } else { (a, b) };
                            stack[waiting] = far;
                            waiting += 1;
                            Some(near)
                        }
                        (a, b) => a.or(b),
                    };
                }
            }
        }
    }
}

/// A lower bound for the `t` of every hit in the box. The result is `None` only if the box has no hit up to `bound`.
fn near(ray: &Ray, bounds: &Aabb, bound: f64) -> Option<f64> {
    let (mut near, mut far) = (f64::from(ray.interval().0), bound);
    let Ray { origin, direction, .. } = ray;
    for axis in 0..3 {
        let (o, d, low, high) = (origin[axis], direction[axis], bounds.min[axis], bounds.max[axis]);
        if d == 0.0 {
            if o < low || high < o {
                return None;
            }
            continue;
        }
        let (first, last) = if d > 0.0 { (low, high) } else { (high, low) };
        let cross = |plane: f32| (f64::from(plane) - f64::from(o)) / f64::from(d);
        let slab = Span::outward(cross(first), cross(last));
        near = near.max(slab.low);
        far = far.min(slab.high);
    }
    (near <= far).then_some(near)
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::*;
    use crate::exact;
    use crate::oracle::tests::Numbers;

    #[test]
    fn every_triangle_that_is_hit_is_visited_once() {
        let mut hits = 0;
        for mut numbers in Numbers::all() {
            let positions: Vec<Vec3> = (0..150).map(|_| numbers.point()).collect();
            let mesh = Mesh::new(positions, (0..50).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect()).unwrap();
            let tree = Tree::new(&mesh);
            for round in 0..60 {
                let origin = if round % 3 == 0 { mesh.positions()[round] } else { numbers.point() };
                let ray = Ray::new(origin, numbers.direction());
                if !ray.is_valid() {
                    continue;
                }
                let mut visits = vec![0; mesh.len()];
                tree.visit(&ray, f64::INFINITY, |id| {
                    visits[id as usize] += 1;
                    f64::INFINITY
                });
                assert!(visits.iter().all(|&visits| visits < 2), "no triangle is visited twice");
                for id in mesh.solid() {
                    if exact::hit(&ray, mesh.corners(id)).is_some_and(|t| t.is_within(&ray)) {
                        hits += 1;
                        assert_eq!(visits[id as usize], 1, "{ray:?} loses triangle {id}");
                    }
                }
            }
        }
        assert!(hits > 500, "{hits}");
    }

    #[test]
    fn rays_in_a_face_of_a_box_are_in_the_box() {
        let bounds = Aabb { min: Vec3::ZERO, max: Vec3::ONE };
        for zero in [0.0, -0.0] {
            for at in [0.0, 0.25, 1.0] {
                let ray = Ray::new(Vec3::new(at, 1.0, -2.0), Vec3::new(zero, zero, 1.0));
                assert_eq!(near(&ray, &bounds, f64::INFINITY).map(|t| t as f32), Some(2.0));
                let beside = Ray { origin: Vec3::new(at, 1.0_f32.next_up(), -2.0), ..ray };
                assert_eq!(near(&beside, &bounds, f64::INFINITY), None);
            }
        }
        let ray = Ray::new(Vec3::new(0.5, 0.5, -2.0), Vec3::Z);
        assert_eq!(near(&ray, &bounds, 1.5), None, "behind the bound");
        assert_eq!(near(&Ray { t_min: 3.5, ..ray }, &bounds, 9.0), None, "before the interval");
    }
}
