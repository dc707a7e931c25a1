//! Moving parts of a finished tree to where they make it cheaper.
//!
//! # References
//! Bittner, Hapala, Havran: Fast Insertion-Based Optimization of Bounding Volume Hierarchies, Computer Graphics Forum 2013.
//! Meister, Bittner: Parallel Reinsertion for Bounding Volume Hierarchy Optimization, Computer Graphics Forum 2018. We depart in
//! that moves found together are tried one after the other, each only if it still pays, so that the result is the same for
//! every number of threads.

use rayon::prelude::*;

use super::binary::{BinaryNode, BinaryTree, Content};
use super::extent::Extent;

/// Nodes whose moves are sought at the same time.
const BATCH: usize = 512;

/// Places that the search for a move looks at.
const VISITS: usize = 512;

/// No move makes a path longer than this: nested boxes would be cheapest as a chain.
const DEEPEST: u32 = 80;

const NONE: u32 = u32::MAX;

/// The tree with links in both directions. Children of a leaf are `NONE`.
struct Links {
    parent: Vec<u32>,
    children: Vec<[u32; 2]>,
    extent: Vec<Extent>,
    /// Edges from a node to the deepest leaf below it.
    height: Vec<u32>,
}

/// Seeks a better place for every node, the largest first, `passes` times. Leaves stay what they are.
pub(in crate::structures) fn reinsert(tree: BinaryTree, passes: u32) -> BinaryTree {
    if tree.nodes.is_empty() || passes == 0 {
        return tree;
    }
    let mut links = Links::new(&tree);
    for _ in 0..passes {
        let area = |at: u32| links.extent[at as usize].half_area();
        // Areas are not negative: their bits are in the same order.
        let mut order: Vec<(u64, u32)> = (1..tree.nodes.len() as u32).map(|at| (!area(at).to_bits(), at)).collect();
        order.par_sort_unstable();
        for batch in order.chunks(BATCH) {
            let targets: Vec<Option<u32>> = batch.par_iter().map(|&(_, at)| links.search(at)).collect();
            for (&(_, at), target) in batch.iter().zip(targets) {
                if let Some(target) = target {
                    links.relocate(at, target);
                }
            }
        }
    }
    links.write(&tree)
}

impl Links {
    fn new(tree: &BinaryTree) -> Self {
        let mut parent = vec![NONE; tree.nodes.len()];
        let mut children = vec![[NONE; 2]; tree.nodes.len()];
        for (at, node) in tree.nodes.iter().enumerate() {
            if let Content::Inner(below) = node.content {
                below.iter().for_each(|&child| parent[child as usize] = at as u32);
                children[at] = below;
            }
        }
        let mut height = vec![0; tree.nodes.len()];
        for (at, &[left, right]) in children.iter().enumerate().rev().filter(|(_, below)| below[0] != NONE) {
            height[at] = 1 + height[left as usize].max(height[right as usize]);
        }
        Self { parent, children, extent: tree.nodes.iter().map(|node| node.bounds.into()).collect(), height }
    }

    fn sibling(&self, at: u32) -> u32 {
        let [a, b] = self.children[self.parent[at as usize] as usize];
        if a == at { b } else { a }
    }

    /// The node beside which `at` saves most area, if any place does.
    fn search(&self, at: u32) -> Option<u32> {
        let own = self.extent[at as usize];
        let own_area = own.half_area();
        let parent = self.parent[at as usize];
        if parent == NONE || self.parent[parent as usize] == NONE {
            return None;
        }

        // Climb; what lies beside the path is searched, knowing what the removal saves on the path up to there.
        let mut saved = self.extent[parent as usize].half_area();
        let mut rest = Extent::EMPTY;
        let (mut best, mut target) = (0.0, None);
        let mut stack = vec![];
        let (mut path, mut visits) = (at, 0);
        loop {
            let beside = self.sibling(path);
            stack.push((beside, saved));
            while let Some((place, saved)) = stack.pop() {
                if saved - own_area <= best || visits == VISITS {
                    continue;
                }
                visits += 1;
                let extent = self.extent[place as usize];
                let gain = saved - extent.union(own).half_area();
                if gain > best {
                    (best, target) = (gain, Some(place));
                }
                let [left, right] = self.children[place as usize];
                if left != NONE {
                    let below = gain + extent.half_area();
                    stack.extend([(left, below), (right, below)]);
                }
            }

            rest.grow(self.extent[beside as usize]);
            path = self.parent[path as usize];
            if self.parent[path as usize] == NONE {
                return target;
            }
            // Beside what is left of a node above; the parent is gone, which is counted from the start.
            if path != parent {
                saved += self.extent[path as usize].half_area() - rest.half_area();
                let gain = saved - rest.union(own).half_area();
                if gain > best {
                    (best, target) = (gain, Some(path));
                }
            }
        }
    }

    /// Moves `at` beside `target`, if by now that is still possible and still saves area.
    fn relocate(&mut self, at: u32, target: u32) {
        let (parent, sibling) = (self.parent[at as usize], self.sibling(at));
        let grand = self.parent[parent as usize];
        let (mut depth, mut up, mut inside) = (0, target, false);
        while up != NONE {
            inside |= up == at;
            (depth, up) = (depth + 1, self.parent[up as usize]);
        }
        let deepest = depth + self.height[at as usize].max(self.height[target as usize]);
        if grand == NONE || target == parent || target == sibling || inside || deepest > DEEPEST {
            return;
        }

        // The parent moves with the node, to become the parent of the target.
        let old_area = self.extent[parent as usize].half_area();
        self.replace(grand, parent, sibling);
        let mut growth = self.refit(grand);
        let above = self.parent[target as usize];
        self.replace(above, target, parent);
        self.join(parent, [target, at]);
        growth += self.extent[parent as usize].half_area() - old_area + self.refit(above);
        if growth < 0.0 {
            return;
        }

        // Moves before this one have spoilt it: take it back.
        self.replace(above, parent, target);
        self.refit(above);
        self.replace(grand, sibling, parent);
        self.join(parent, [sibling, at]);
        self.refit(grand);
    }

    /// Makes `children` the children of `parent`.
    fn join(&mut self, parent: u32, children: [u32; 2]) {
        self.children[parent as usize] = children;
        children.iter().for_each(|&child| self.parent[child as usize] = parent);
        let [a, b] = children.map(|child| self.extent[child as usize]);
        self.extent[parent as usize] = a.union(b);
        self.height[parent as usize] = self.height_over(parent);
    }

    fn height_over(&self, at: u32) -> u32 {
        let [a, b] = self.children[at as usize].map(|child| self.height[child as usize]);
        1 + a.max(b)
    }

    fn replace(&mut self, parent: u32, old: u32, new: u32) {
        let slot = usize::from(self.children[parent as usize][1] == old);
        self.children[parent as usize][slot] = new;
        self.parent[new as usize] = parent;
    }

    /// Recomputes boxes and heights from `at` up, as far as they change; by how much their areas have grown together.
    fn refit(&mut self, mut at: u32) -> f64 {
        let mut growth = 0.0;
        while at != NONE {
            let [left, right] = self.children[at as usize].map(|child| self.extent[child as usize]);
            let (old, new) = (self.extent[at as usize], left.union(right));
            let height = self.height_over(at);
            if old.min == new.min && old.max == new.max && self.height[at as usize] == height {
                break;
            }
            self.height[at as usize] = height;
            growth += new.half_area() - old.half_area();
            self.extent[at as usize] = new;
            at = self.parent[at as usize];
        }
        growth
    }

    /// The nodes and references of `tree` as they are linked now, depth first.
    fn write(&self, tree: &BinaryTree) -> BinaryTree {
        let mut order = Vec::with_capacity(tree.nodes.len());
        let mut stack = vec![0];
        while let Some(at) = stack.pop() {
            order.push(at);
            let [left, right] = self.children[at as usize];
            if left != NONE {
                stack.extend([right, left]);
            }
        }

        let mut number = vec![0; order.len()];
        (0..).zip(&order).for_each(|(new, &old): (u32, &u32)| number[old as usize] = new);
        let mut references = Vec::with_capacity(tree.references.len());
        let node = |&at: &u32| {
            let content = match tree.nodes[at as usize].content {
                Content::Inner(_) => Content::Inner(self.children[at as usize].map(|child| number[child as usize])),
                Content::Leaf { first, count } => {
                    let start = references.len() as u32;
                    references.extend_from_slice(&tree.references[first as usize..(first + count) as usize]);
                    Content::Leaf { first: start, count }
                }
            };
            BinaryNode { bounds: self.extent[at as usize].into(), content }
        };
        let nodes = order.iter().map(node).collect();
        BinaryTree { nodes, references }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::structures::binary_check::{covers, disjoint, leaves, mesh, room, soup};
    use crate::structures::split::{Quality, SplitConfig, Splits, build};
    use glam::Vec3;

    fn area(tree: &BinaryTree) -> f64 {
        tree.nodes.iter().map(|node| Extent::from(node.bounds).half_area()).sum()
    }

    fn binary(mesh: &crate::geometry::Mesh, splits: Splits) -> BinaryTree {
        build(mesh, &SplitConfig::new(splits, Quality::Balanced))
    }

    #[test]
    fn moves_save_area_and_leave_the_leaves_as_they_were() {
        // Nothing is to be gained in a regular room.
        for (mesh, irregular) in [(soup(4000, 21), true), (room(12), false)] {
            for splits in [Splits::Spatial, Splits::SpatialAndObject, Splits::Object] {
                let before = binary(&mesh, splits);
                let after = reinsert(before.clone(), 3);
                let (old, new) = (area(&before), area(&after));
                assert!(if irregular { new < old } else { new <= old }, "{splits:?}: {new} of {old}");
                let sorted = |tree: &BinaryTree| {
                    let mut all: Vec<String> = leaves(tree, 64).iter().map(|leaf| format!("{leaf:?}")).collect();
                    all.sort();
                    all
                };
                assert!(sorted(&after) == sorted(&before));
                covers(&after, &mesh, 22);
                if splits == Splits::Spatial {
                    disjoint(&leaves(&after, 64));
                }
            }
        }
    }

    #[test]
    fn the_search_finds_what_trying_every_place_finds() {
        let tree = binary(&soup(400, 23), Splits::Object);
        let links = Links::new(&tree);
        let total = |links: &Links| links.extent.iter().map(Extent::half_area).sum::<f64>();
        let before = total(&links);
        for at in 1..tree.nodes.len() as u32 {
            let gain = |target: u32| {
                let mut moved =
                    Links { parent: links.parent.clone(), children: links.children.clone(), ..Links::new(&tree) };
                moved.relocate(at, target);
                before - total(&moved)
            };
            let most = (1..tree.nodes.len() as u32).map(gain).fold(0.0, f64::max);
            let found = links.search(at).map_or(0.0, gain);
            assert!((most - found).abs() <= 1e-12 * before, "{at}: {found} instead of {most}");
        }
    }

    #[test]
    fn moves_do_not_depend_on_the_number_of_threads() {
        let tree = binary(&soup(20_000, 24), Splits::Object);
        let run = |threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            let moved = pool.install(|| reinsert(tree.clone(), 2));
            (format!("{:?}", moved.nodes), moved.references)
        };
        let one = run(1);
        assert!(one == run(2) && one == run(3));
    }

    #[test]
    fn nested_and_coincident_boxes_do_not_make_chains() {
        let nested = mesh(20_000, |i| [Vec3::X, Vec3::Y, Vec3::Z].map(|p| p * 0.998f32.powi(i as i32)));
        let coincident = mesh(20_000, |_| [Vec3::X, Vec3::Y, Vec3::Z]);
        assert!(reinsert(BinaryTree::default(), 4).nodes.is_empty());
        for mesh in [nested, coincident] {
            let tree = reinsert(binary(&mesh, Splits::Object), 4);
            assert!(Links::new(&tree).height[0] <= DEEPEST);
            covers(&tree, &mesh, 25);
        }
    }
}
