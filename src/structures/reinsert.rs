//! Moving parts of a finished tree to where they make it cheaper.
//!
//! # References
//! Bittner, Hapala, Havran: Fast Insertion-Based Optimization of Bounding Volume Hierarchies, Computer Graphics Forum 2013.
//! Meister, Bittner: Parallel Reinsertion for Bounding Volume Hierarchy Optimization, Computer Graphics Forum 2018. We depart in
//! that moves found together are tried one after the other, each only if it still pays, so that the result is the same for
//! every number of threads; and in how many nodes a pass looks at.

use std::ops::{Index, IndexMut};

use rayon::prelude::*;

use super::binary::{BinaryNode, BinaryTree, Content};
use super::extent::Extent;

/// Nodes whose moves are sought at the same time.
const BATCH: usize = 512;

/// The share of the nodes that the first pass looks at, those of the largest boxes; the k-th pass looks at a k-th of that. Four such passes
/// leave 0.97 to 0.99 of the area that two over all nodes leave (groups; kitchen, engine, Sponza), in six tenths of the time.
const SHARE: f64 = 0.6;

/// Places that the search for a move looks at.
const VISITS: usize = 512;

/// No move makes a path longer than this: nested boxes would be cheapest as a chain.
const DEEPEST: u32 = 80;

const NONE: u32 = u32::MAX;

/// A node with links in both directions: all that a search reads of it, in one cache line.
#[derive(Clone, Copy)]
#[repr(align(64))]
struct Link {
    extent: Extent,
    /// Half of the surface area of the box.
    area: f64,
    /// `NONE` for a leaf.
    children: [u32; 2],
    /// `NONE` for the root.
    parent: u32,
    /// Edges to the deepest leaf below.
    height: u32,
}

const _: () = assert!(size_of::<Link>() == 64);

impl Link {
    fn is_leaf(&self) -> bool {
        self.children[0] == NONE
    }

    fn set(&mut self, extent: Extent) {
        (self.extent, self.area) = (extent, extent.half_area());
    }
}

/// The tree that is changed.
#[derive(Clone)]
struct Links(Vec<Link>);

impl Index<u32> for Links {
    type Output = Link;

    fn index(&self, at: u32) -> &Link {
        &self.0[at as usize]
    }
}

impl IndexMut<u32> for Links {
    fn index_mut(&mut self, at: u32) -> &mut Link {
        &mut self.0[at as usize]
    }
}

/// Seeks better places for the nodes of the largest boxes, the largest first, `passes` times. Leaves stay what they are.
pub(in crate::structures) fn reinsert(tree: BinaryTree, passes: u32) -> BinaryTree {
    if tree.nodes.len() < 2 || passes == 0 {
        return tree;
    }
    let mut links = Links::new(&tree);
    for pass in 1..=passes {
        // Areas are not negative: their bits are in the same order.
        let key = |at: u32| (!links[at].area.to_bits(), at);
        let mut order: Vec<(u64, u32)> = (1..tree.nodes.len() as u32).into_par_iter().map(key).collect();
        let looked_at = (order.len() as f64 * SHARE / f64::from(pass)) as usize;
        order.select_nth_unstable(looked_at);
        order.truncate(looked_at);
        order.par_sort_unstable();
        for batch in order.chunks(BATCH) {
            let search = |stack: &mut Vec<_>, &(_, at): &(u64, u32)| links.search(at, stack);
            let targets: Vec<Option<u32>> = batch.par_iter().map_init(Vec::new, search).collect();
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
        let link = |node: &BinaryNode| {
            let extent = Extent::from(node.bounds);
            let children = if let Content::Inner(below) = node.content { below } else { [NONE; 2] };
            Link { extent, area: extent.half_area(), children, parent: NONE, height: 0 }
        };
        let mut links = Self(tree.nodes.par_iter().map(link).collect());
        // Children come after their parents.
        for at in (0..tree.nodes.len() as u32).rev() {
            if links[at].is_leaf() {
                continue;
            }
            for child in links[at].children {
                links[child].parent = at;
            }
            links[at].height = links.height_over(at);
        }
        links
    }

    fn sibling(&self, at: u32) -> u32 {
        let [a, b] = self[self[at].parent].children;
        if a == at { b } else { a }
    }

    /// The node beside which `at` saves most area, if any place does.
    fn search(&self, at: u32, stack: &mut Vec<(u32, f64)>) -> Option<u32> {
        let Link { extent: own, area: own_area, parent, .. } = self[at];
        if parent == NONE || self[parent].parent == NONE {
            return None;
        }

        // Climb; what lies beside the path is searched, knowing what the removal saves on the path up to there.
        let mut saved = self[parent].area;
        let mut rest = Extent::EMPTY;
        let (mut best, mut target) = (0.0, None);
        stack.clear();
        let (mut path, mut visits) = (at, 0);
        loop {
            let beside = self.sibling(path);
            stack.push((beside, saved));
            while let Some((place, saved)) = stack.pop() {
                if saved - own_area <= best || visits == VISITS {
                    continue;
                }
                visits += 1;
                let link = &self[place];
                let gain = saved - link.extent.union(own).half_area();
                if gain > best {
                    (best, target) = (gain, Some(place));
                }
                let below = gain + link.area;
                if !link.is_leaf() && below - own_area > best {
                    stack.extend(link.children.map(|child| (child, below)));
                }
            }

            rest.grow(self[beside].extent);
            path = self[path].parent;
            if self[path].parent == NONE {
                return target;
            }
            // Beside what is left of a node above; the parent is gone, which is counted from the start.
            if path != parent {
                saved += self[path].area - rest.half_area();
                let gain = saved - rest.union(own).half_area();
                if gain > best {
                    (best, target) = (gain, Some(path));
                }
            }
        }
    }

    /// Moves `at` beside `target`, if by now that is still possible and still saves area.
    fn relocate(&mut self, at: u32, target: u32) {
        let (parent, sibling) = (self[at].parent, self.sibling(at));
        let grand = self[parent].parent;
        let (mut depth, mut up, mut inside) = (0, target, false);
        while up != NONE {
            inside |= up == at;
            (depth, up) = (depth + 1, self[up].parent);
        }
        let deepest = depth + self[at].height.max(self[target].height);
        if grand == NONE || target == parent || target == sibling || inside || deepest > DEEPEST {
            return;
        }

        // The parent moves with the node, to become the parent of the target.
        let old_area = self[parent].area;
        self.replace(grand, parent, sibling);
        let mut growth = self.refit(grand);
        let above = self[target].parent;
        self.replace(above, target, parent);
        self.join(parent, [target, at]);
        growth += self[parent].area - old_area + self.refit(above);
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
        self[parent].children = children;
        children.iter().for_each(|&child| self[child].parent = parent);
        let extent = self.extent_over(parent);
        self[parent].set(extent);
        self[parent].height = self.height_over(parent);
    }

    fn extent_over(&self, at: u32) -> Extent {
        let [a, b] = self[at].children.map(|child| self[child].extent);
        a.union(b)
    }

    fn height_over(&self, at: u32) -> u32 {
        let [a, b] = self[at].children.map(|child| self[child].height);
        1 + a.max(b)
    }

    fn replace(&mut self, parent: u32, old: u32, new: u32) {
        let slot = usize::from(self[parent].children[1] == old);
        self[parent].children[slot] = new;
        self[new].parent = parent;
    }

    /// Recomputes boxes and heights from `at` up, as far as they change; by how much their areas have grown together.
    fn refit(&mut self, mut at: u32) -> f64 {
        let mut growth = 0.0;
        while at != NONE {
            let (new, height) = (self.extent_over(at), self.height_over(at));
            let link = &mut self[at];
            if link.extent.min == new.min && link.extent.max == new.max && link.height == height {
                break;
            }
            let old_area = link.area;
            link.set(new);
            link.height = height;
            growth += link.area - old_area;
            at = link.parent;
        }
        growth
    }

    /// The nodes and references of `tree` as they are linked now, depth first.
    fn write(&self, tree: &BinaryTree) -> BinaryTree {
        let mut order = Vec::with_capacity(tree.nodes.len());
        let mut stack = vec![0];
        while let Some(at) = stack.pop() {
            order.push(at);
            if !self[at].is_leaf() {
                let [left, right] = self[at].children;
                stack.extend([right, left]);
            }
        }

        let mut number = vec![0; order.len()];
        (0..).zip(&order).for_each(|(new, &old): (u32, &u32)| number[old as usize] = new);
        let mut references = Vec::with_capacity(tree.references.len());
        let mut starts = Vec::with_capacity(order.len());
        for &at in &order {
            starts.push(references.len() as u32);
            if let Content::Leaf { first, count } = tree.nodes[at as usize].content {
                references.extend_from_slice(&tree.references[first as usize..(first + count) as usize]);
            }
        }
        let node = |(&at, &first): (&u32, &u32)| {
            let content = match tree.nodes[at as usize].content {
                Content::Inner(_) => Content::Inner(self[at].children.map(|child| number[child as usize])),
                Content::Leaf { count, .. } => Content::Leaf { first, count },
            };
            BinaryNode { bounds: self[at].extent.into(), content }
        };
        let nodes = order.par_iter().zip(&starts).map(node).collect();
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
    fn small_trees_and_passes_that_look_at_nothing_do_no_harm() {
        for triangles in 1..40 {
            let mesh = soup(triangles, 26);
            let tree = reinsert(binary(&mesh, Splits::Object), 50);
            covers(&tree, &mesh, 27);
            assert_eq!(leaves(&tree, 64).iter().map(|leaf| leaf.1.len()).sum::<usize>(), triangles);
        }
    }

    #[test]
    fn the_search_finds_what_trying_every_place_finds() {
        let tree = binary(&soup(400, 23), Splits::Object);
        let links = Links::new(&tree);
        let total = |links: &Links| links.0.iter().map(|link| link.area).sum::<f64>();
        let before = total(&links);
        for at in 1..tree.nodes.len() as u32 {
            let gain = |target: u32| {
                let mut moved = links.clone();
                moved.relocate(at, target);
                before - total(&moved)
            };
            let most = (1..tree.nodes.len() as u32).map(gain).fold(0.0, f64::max);
            let found = links.search(at, &mut vec![]).map_or(0.0, gain);
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
            assert!(Links::new(&tree)[0].height <= DEEPEST);
            covers(&tree, &mesh, 25);
        }
    }
}
