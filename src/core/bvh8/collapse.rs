//! Collapses a binary tree to a wide tree, by dynamic programming.
//!
//! # References
//! Ylitie, Karras, Laine: Efficient incoherent ray traversal on GPUs through compressed wide BVHs. HPG 2017, section 4.

use super::node::WIDTH;
use crate::build::binary_tree::{BinaryTree, Content};
use crate::build::sah_cost::CostModel;
use crate::geometry::Aabb;

/// Maximum number of blocks in a leaf that is merged from several leaves.
const MAX_MERGED_BLOCKS: usize = 8;

const PARALLEL: usize = 2048;

/// For each binary subtree, the cheapest division into a limited number of [`Part`]s.
pub(super) struct Collapse<'a> {
    pub(super) tree: &'a BinaryTree,
    best: Vec<Best>,
}

#[derive(Clone, Copy)]
struct Best {
    /// `cost[i]`: the cost of the subtree if it is divided into at most `i + 1` parts.
    cost: [f32; WIDTH - 1],
    /// `left[i]`: how many of `i + 1` parts the left child gets. The value is 0 if fewer parts cost no more.
    /// `left[WIDTH - 1]` is used only if the node becomes a wide node.
    left: [u8; WIDTH],
    /// Whether the node becomes a leaf if it is a single part.
    leaf: bool,
    references: [u32; 2],
    /// A lower bound for the number of distinct triangles below the node.
    triangles: u32,
}

impl Best {
    const NONE: Self = Self { cost: [0.0; WIDTH - 1], left: [0; WIDTH], leaf: true, references: [0; 2], triangles: 0 };
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Part {
    Node(u32),
    /// All triangles below the binary node become one leaf.
    Leaf(u32),
}

pub(super) struct Children {
    parts: [Part; WIDTH],
    len: usize,
    /// The visiting orders, in the format of `Node::orders`.
    pub orders: [u32; 8],
}

impl Children {
    /// The parts in the order of their lanes. Parts occupy the highest lanes of the node.
    pub fn parts(&self) -> &[Part] {
        &self.parts[..self.len]
    }
}

struct Chooser<'a> {
    tree: &'a BinaryTree,
    costs: &'a CostModel,
    /// The half area of the root. Relative to this area, costs fit an `f32`.
    whole: f64,
}

impl Chooser<'_> {
    /// `best` has one entry per node of the subtree at `at`, in depth-first order.
    fn choose(&self, at: usize, best: &mut [Best], ids: &mut Vec<u32>) {
        let node = &self.tree.nodes[at];
        let area = node.bounds.half_area() / self.whole;
        let (own, below) = best.split_first_mut().expect("`best` starts with the node itself");
        *own = match node.content {
            Content::Leaf { first, count } => Best {
                cost: [self.as_leaf(area, count); WIDTH - 1],
                references: [first, first + count],
                triangles: count,
                ..Best::NONE
            },
            Content::Inner([_, second]) => {
                let second = second as usize;
                let together = below.len() < PARALLEL;
                let (left, right) = below.split_at_mut(second - at - 1);
                if together {
                    self.choose(at + 1, left, ids);
                    self.choose(second, right, ids);
                } else {
                    rayon::join(|| self.choose(at + 1, left, ids), || self.choose(second, right, &mut vec![]));
                }
                self.inner(area, [&left[0], &right[0]], ids)
            }
        };
    }

    fn inner(&self, area: f64, [l, r]: [&Best; 2], ids: &mut Vec<u32>) -> Best {
        let distribute = |parts: usize| {
            let with = |left: usize| (l.cost[left - 1] + r.cost[parts - left - 1], left as u8);
            (1..parts).map(with).min_by(|a, b| a.0.total_cmp(&b.0)).expect("at least two parts")
        };
        let mut best = Best {
            references: [l.references[0], r.references[1]],
            triangles: l.triangles.max(r.triangles),
            ..Best::NONE
        };
        let (inner, left) = distribute(WIDTH);
        best.left[WIDTH - 1] = left;
        let as_node = self.costs.box_node(area, f64::from(inner)) as f32;
        let as_leaf = self.merged(area, as_node, &mut best, ids);
        best.leaf = as_leaf <= as_node && as_leaf.is_finite();
        best.cost[0] = if best.leaf { as_leaf } else { as_node };
        for parts in 2..WIDTH {
            let (cost, left) = distribute(parts);
            (best.cost[parts - 1], best.left[parts - 1]) =
                if cost < best.cost[parts - 2] { (cost, left) } else { (best.cost[parts - 2], 0) };
        }
        best
    }

    /// Returns infinity if the leaf is too large. May return infinity if the leaf costs more than `limit`.
    fn merged(&self, area: f64, limit: f32, best: &mut Best, ids: &mut Vec<u32>) -> f32 {
        let most = (MAX_MERGED_BLOCKS * WIDTH) as u32;
        let [first, end] = best.references;
        if end - first > 2 * most || best.triangles > most || self.as_leaf(area, best.triangles) > limit {
            return f32::INFINITY;
        }
        // Several leaves may contain the same triangle, so count distinct triangles.
        ids.clear();
        ids.extend_from_slice(&self.tree.references[first as usize..end as usize]);
        ids.sort_unstable();
        ids.dedup();
        best.triangles = ids.len() as u32;
        if best.triangles <= most { self.as_leaf(area, best.triangles) } else { f32::INFINITY }
    }

    fn as_leaf(&self, area: f64, count: u32) -> f32 {
        self.costs.box_leaf(area, count as usize) as f32
    }
}

impl<'a> Collapse<'a> {
    pub fn new(tree: &'a BinaryTree, costs: &CostModel) -> Self {
        let mut best = vec![Best::NONE; tree.nodes.len()];
        if let Some(root) = tree.nodes.first() {
            let whole = Some(root.bounds.half_area()).filter(|&whole| whole > 0.0).unwrap_or(1.0);
            Chooser { tree, costs, whole }.choose(0, &mut best, &mut vec![]);
            // The root becomes a wide node even if the binary tree is a single leaf. The traversals treat a leaf at the
            // root as an empty tree.
            best[0].leaf = false;
        }
        Self { tree, best }
    }

    pub fn root(&self) -> Option<Part> {
        (!self.best.is_empty()).then(|| self.part(0))
    }

    /// A triangle may occur several times.
    pub fn references(&self, part: Part) -> &[u32] {
        let (Part::Node(at) | Part::Leaf(at)) = part;
        let [first, end] = self.best[at as usize].references;
        &self.tree.references[first as usize..end as usize]
    }

    pub fn children(&self, at: u32) -> Children {
        let (mut found, mut len) = ([Part::Leaf(0); WIDTH], 0);
        self.gather(at, WIDTH, &mut |part| {
            // In a tree of one leaf, `gather` visits node `at` itself. As a `Part::Node`, `at` would be its own child.
            found[len] = if part == Part::Node(at) { Part::Leaf(at) } else { part };
            len += 1;
        });
        // Any-hit queries begin at the highest lane. Leaves get higher lanes than nodes. Among leaves, and among nodes,
        // larger boxes get higher lanes.
        let keys = found.map(|part| (matches!(part, Part::Leaf(_)), self.bounds(part).half_area()));
        let mut places: [usize; WIDTH] = std::array::from_fn(|place| place);
        places[..len].sort_by(|&a, &b| keys[a].0.cmp(&keys[b].0).then(keys[a].1.total_cmp(&keys[b].1)));
        let empty = WIDTH - len;
        let mut lanes = [0; WIDTH];
        (empty as u32..).zip(&places[..len]).for_each(|(lane, &place)| lanes[place] = lane);

        let unused = (0..empty as u32).rev().fold(0, |order, lane| order << 3 | lane);
        let orders = self.orders(at, WIDTH, &mut lanes.iter()).0.map(|order| order << (3 * empty) | unused);
        Children { parts: places.map(|place| found[place]), len, orders }
    }

    pub(super) fn part(&self, at: u32) -> Part {
        if self.best[at as usize].leaf { Part::Leaf(at) } else { Part::Node(at) }
    }

    /// Both children of `at`, each with its number of parts. The sum of the two numbers is at most `parts`. `None` if
    /// `at` is a single part.
    pub(super) fn divided(&self, at: u32, parts: usize) -> Option<[(u32, usize); 2]> {
        let left = |parts: usize| (parts, self.best[at as usize].left[parts - 1] as usize);
        let (parts, left) = (1..=parts).rev().map(left).find(|&(_, left)| left > 0)?;
        match self.tree.nodes[at as usize].content {
            Content::Inner([l, r]) => Some([(l, left), (r, parts - left)]),
            Content::Leaf { .. } => None,
        }
    }

    fn gather(&self, at: u32, parts: usize, visit: &mut impl FnMut(Part)) {
        match self.divided(at, parts) {
            Some(sides) => sides.iter().for_each(|&(at, parts)| self.gather(at, parts, visit)),
            None => visit(self.part(at)),
        }
    }

    pub fn bounds(&self, part: Part) -> &Aabb {
        let (Part::Node(at) | Part::Leaf(at)) = part;
        &self.tree.nodes[at as usize].bounds
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::build::Quality;
    use crate::build::check::soup;
    use crate::build::sbvh::{SbvhConfig, Splits, build};

    /// The collapse counts distinct triangles of a merged leaf only if the leaf may be cheaper than a node.
    #[test]
    fn leaves_that_are_not_counted_would_not_have_won() {
        let tree = build(&soup(3000, 44), &SbvhConfig::new(Splits::Spatial, Quality::Balanced));
        for block in [0.05, 1.0, 20.0] {
            let costs = CostModel::new(1.0, block, 0.0);
            let collapse = Collapse::new(&tree, &costs);
            let whole = tree.nodes[0].bounds.half_area();
            let chooser = Chooser { tree: &tree, costs: &costs, whole };
            for (at, best) in collapse.best.iter().enumerate() {
                let Content::Inner([_, second]) = tree.nodes[at].content else { continue };
                let area = tree.nodes[at].bounds.half_area() / whole;
                let mut ids = tree.references[best.references[0] as usize..best.references[1] as usize].to_vec();
                ids.sort_unstable();
                ids.dedup();
                assert!(best.triangles as usize <= ids.len());
                let [l, r] = [at + 1, second as usize].map(|child| &collapse.best[child]);
                let inner =
                    (1..WIDTH).map(|left| l.cost[left - 1] + r.cost[WIDTH - left - 1]).fold(f32::INFINITY, f32::min);
                let as_node = (area + f64::from(inner)) as f32;
                let fits = ids.len() <= 64 && best.references[1] - best.references[0] <= 128;
                assert_eq!(best.leaf, fits && chooser.as_leaf(area, ids.len() as u32) <= as_node, "{at}");
            }
            assert!(collapse.best.iter().any(|best| !best.leaf));
        }
    }
}
