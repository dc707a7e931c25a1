//! A binary tree whose subtrees can be moved.

use std::ops::{Index, IndexMut};

use rayon::prelude::*;

use crate::build::binary_tree::{BinaryNode, BinaryTree, Content};
use crate::build::extent::Extent;

pub(super) const NONE: u32 = u32::MAX;

/// Maximum depth that a move may create. Without a limit, moves turn nested boxes into a chain, because a chain is
/// their cheapest tree.
pub(super) const DEEPEST: u32 = 80;

/// A node with links to its parent and children. A `Link` fills one cache line.
#[derive(Clone, Copy)]
#[repr(align(64))]
pub(super) struct Link {
    pub extent: Extent,
    /// Half of the surface area.
    pub area: f64,
    /// `NONE` for a leaf.
    pub children: [u32; 2],
    /// `NONE` for the root.
    pub parent: u32,
    /// Number of edges to the deepest leaf below.
    pub height: u32,
}

const _: () = assert!(size_of::<Link>() == 64);

impl Link {
    pub fn is_leaf(&self) -> bool {
        self.children[0] == NONE
    }

    fn set(&mut self, extent: Extent) {
        (self.extent, self.area) = (extent, extent.half_area());
    }
}

#[derive(Clone)]
pub(super) struct Links(pub Vec<Link>);

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

impl Links {
    pub fn new(tree: &BinaryTree) -> Self {
        let link = |node: &BinaryNode| {
            let extent = Extent::from(node.bounds);
            let children = if let Content::Inner(below) = node.content { below } else { [NONE; 2] };
            Link { extent, area: extent.half_area(), children, parent: NONE, height: 0 }
        };
        let mut links = Self(tree.nodes.par_iter().map(link).collect());
        // Children have larger indices than their parents, so the reverse order visits children first.
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

    pub fn sibling(&self, at: u32) -> u32 {
        let [a, b] = self[self[at].parent].children;
        if a == at { b } else { a }
    }

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

    /// Recomputes boxes and heights upward from `at`. Returns the total change of area.
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

    /// Makes `at` the sibling of `target`. Does nothing if the move is impossible or saves no area after earlier
    /// moves, or if it exceeds `DEEPEST`.
    pub fn relocate(&mut self, at: u32, target: u32) {
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

        // The parent of `at` becomes the parent of `target` and `at`.
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

        // The move saves no area, so undo the move.
        self.replace(above, parent, target);
        self.refit(above);
        self.replace(grand, sibling, parent);
        self.join(parent, [sibling, at]);
        self.refit(grand);
    }

    /// The tree with the current links, in depth-first order. `tree` is the tree before all moves.
    pub fn write(&self, tree: &BinaryTree) -> BinaryTree {
        let mut order = Vec::with_capacity(tree.nodes.len());
        let mut number = vec![0; tree.nodes.len()];
        let mut references = Vec::with_capacity(tree.references.len());
        let mut starts = Vec::with_capacity(tree.nodes.len());
        let mut stack = vec![0];
        while let Some(at) = stack.pop() {
            number[at as usize] = order.len() as u32;
            order.push(at);
            starts.push(references.len() as u32);
            match tree.nodes[at as usize].content {
                Content::Leaf { first, count } => {
                    references.extend_from_slice(&tree.references[first as usize..(first + count) as usize]);
                }
                Content::Inner(_) => {
                    let [left, right] = self[at].children;
                    stack.extend([right, left]);
                }
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
