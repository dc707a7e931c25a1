//! Which nodes of a binary tree become nodes and leaves of a wide one, chosen by dynamic programming.
//!
//! # References
//! Ylitie, Karras, Laine: Efficient incoherent ray traversal on GPUs through compressed wide BVHs. HPG 2017, section 4.

use crate::geometry::Aabb;
use crate::structures::binary::{BinaryTree, Content};
use crate::structures::extent::Extent;

use super::node::WIDTH;

/// What visiting costs, relative to each other.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cost {
    pub node: f64,
    pub block: f64,
    /// Blocks of the largest leaf.
    pub largest: usize,
}

/// For each node of a binary tree how it is represented best by at most 1 to 7 parts.
pub(super) struct Collapse<'a> {
    tree: &'a BinaryTree,
    best: Vec<Best>,
}

/// The choices for one node.
#[derive(Clone, Copy)]
struct Best {
    /// `cost[i]`: of at most `i + 1` parts.
    cost: [f32; WIDTH - 1],
    /// `left[i]`: how many of at most `i + 1` parts the first child gets; 0 where one part less is as good.
    /// `left[WIDTH - 1]`: the same where the node is a wide node.
    left: [u8; WIDTH],
    /// Whether one part alone is a leaf.
    leaf: bool,
}

/// A part of the tree that becomes one child of a wide node.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Part {
    /// The binary node becomes a wide node.
    Node(u32),
    /// All triangles below the binary node become a leaf.
    Leaf(u32),
}

fn half_area(bounds: &Aabb) -> f64 {
    Extent::from(*bounds).half_area()
}

impl<'a> Collapse<'a> {
    pub fn new(tree: &'a BinaryTree, cost: &Cost) -> Self {
        let none = Best { cost: [0.0; WIDTH - 1], left: [0; WIDTH], leaf: true };
        let mut collapse = Self { tree, best: vec![none; tree.nodes.len()] };
        let mut counts = vec![0_u32; tree.nodes.len()];
        let mut ids = vec![];
        let most = cost.largest * WIDTH;
        // Shares of the root's area fit an `f32`, whatever the unit of length.
        let whole = tree.nodes.first().map(|root| half_area(&root.bounds)).filter(|&whole| whole > 0.0).unwrap_or(1.0);
        for at in (0..tree.nodes.len()).rev() {
            let node = &tree.nodes[at];
            let area = half_area(&node.bounds) / whole;
            let as_leaf = |count: usize| (area * cost.block * count.div_ceil(WIDTH) as f64) as f32;
            match node.content {
                Content::Leaf { count, .. } => {
                    counts[at] = count;
                    collapse.best[at].cost = [as_leaf(count as usize); WIDTH - 1];
                }
                Content::Inner(children) => {
                    counts[at] = children.iter().map(|&child| counts[child as usize]).sum();
                    // A triangle may be in several leaves: count again before giving up.
                    let mut merged = f32::INFINITY;
                    if counts[at] as usize <= 2 * most {
                        collapse.ids(at as u32, &mut ids);
                        if ids.len() <= most {
                            merged = as_leaf(ids.len());
                        }
                    }
                    collapse.best[at] = collapse.choose(children, area * cost.node, merged);
                }
            }
        }
        collapse
    }

    fn choose(&self, children: [u32; 2], own: f64, as_leaf: f32) -> Best {
        let [l, r] = children.map(|child| &self.best[child as usize]);
        // The best way to give `parts` to the two children.
        let distribute = |parts: usize| {
            let with = |left: usize| (l.cost[left - 1] + r.cost[parts - left - 1], left as u8);
            (1..parts).map(with).min_by(|a, b| a.0.total_cmp(&b.0)).expect("at least two parts")
        };
        let mut best = Best { cost: [as_leaf; WIDTH - 1], left: [0; WIDTH], leaf: true };
        let (inner, left) = distribute(WIDTH);
        best.left[WIDTH - 1] = left;
        let as_node = (own + f64::from(inner)) as f32;
        if as_node < as_leaf || as_leaf.is_infinite() {
            (best.cost[0], best.leaf) = (as_node, false);
        }
        for parts in 2..WIDTH {
            let (cost, left) = distribute(parts);
            (best.cost[parts - 1], best.left[parts - 1]) =
                if cost < best.cost[parts - 2] { (cost, left) } else { (best.cost[parts - 2], 0) };
        }
        best
    }

    /// What the root becomes.
    pub fn root(&self) -> Part {
        self.part(0)
    }

    /// The children of the wide node `at`, in the order of lanes, and for each octant of directions the order that nodes hold.
    pub fn children(&self, at: u32, parts: &mut Vec<Part>) -> [u32; 8] {
        parts.clear();
        self.gather(at, WIDTH, 0, &mut |part| parts.push(part));
        let size = |part: &Part| half_area(self.bounds(*part));
        let is_leaf = |part: &Part| matches!(part, Part::Leaf(_));
        parts.sort_by(|a, b| is_leaf(a).cmp(&is_leaf(b)).then(size(a).total_cmp(&size(b))));
        std::array::from_fn(|octant| {
            // Empty lanes come before the first.
            let mut order = (parts.len()..WIDTH).fold(0, |order, lane| order << 3 | lane as u32);
            self.gather(at, WIDTH, octant, &mut |part| {
                let lane = parts.iter().position(|&p| p == part).expect("the same parts in another order");
                order = order << 3 | lane as u32;
            });
            order
        })
    }

    fn part(&self, at: u32) -> Part {
        if self.best[at as usize].leaf { Part::Leaf(at) } else { Part::Node(at) }
    }

    /// Visits the at most `parts` parts of `at`, nearest first as rays of an octant see them.
    fn gather(&self, at: u32, parts: usize, octant: usize, visit: &mut impl FnMut(Part)) {
        let left = self.best[at as usize].left[parts - 1] as usize;
        match self.tree.nodes[at as usize].content {
            Content::Inner([l, r]) if left > 0 => {
                let [first, second] = [(l, left), (r, parts - left)];
                let swap = self.swapped(l, r, octant);
                let (first, second) = if swap { (second, first) } else { (first, second) };
                self.gather(first.0, first.1, octant, visit);
                self.gather(second.0, second.1, octant, visit);
            }
            _ if parts == 1 => visit(self.part(at)),
            _ => self.gather(at, parts - 1, octant, visit),
        }
    }

    /// Whether rays of the octant should visit `r` before `l`: by the axis along which the boxes are furthest apart.
    fn swapped(&self, l: u32, r: u32, octant: usize) -> bool {
        let [l, r] = [l, r].map(|at| &self.tree.nodes[at as usize].bounds);
        let (up, down) = (r.min - l.max, l.min - r.max);
        let apart = up.max(down);
        let axis = (0..3).reduce(|a, b| if apart[b] > apart[a] { b } else { a }).unwrap_or(0);
        (down[axis] > up[axis]) != (octant >> axis & 1 == 1)
    }

    /// The different triangles below a node, in ascending order.
    pub fn ids(&self, at: u32, ids: &mut Vec<u32>) {
        ids.clear();
        let mut stack = vec![at];
        while let Some(at) = stack.pop() {
            match self.tree.nodes[at as usize].content {
                Content::Inner(children) => stack.extend(children),
                Content::Leaf { first, count } => {
                    ids.extend_from_slice(&self.tree.references[first as usize..(first + count) as usize]);
                }
            }
        }
        ids.sort_unstable();
        ids.dedup();
    }

    pub fn bounds(&self, part: Part) -> &Aabb {
        let (Part::Node(at) | Part::Leaf(at)) = part;
        &self.tree.nodes[at as usize].bounds
    }
}
