//! Writes the nodes and leaf blocks of a tree.

use rayon::prelude::*;

use super::collapse::{Collapse, Part};
use super::node::{Child, Limits, Node, WIDTH};
use crate::accel::BuildError;
use crate::geometry::Mesh;
use crate::traversal::leaf::LeafBlock;
use crate::traversal::pages;
use crate::triangle::TriangleTest;

/// A subtree with at most this many references is written by one thread.
pub(super) const PIECE: usize = 4096;

pub(super) struct Layout<T: TriangleTest> {
    pub root: Child,
    pub nodes: Vec<Node>,
    pub blocks: Vec<LeafBlock<T>>,
}

impl<T: TriangleTest> Layout<T> {
    /// `most` is the maximum number of references of a subtree that a separate [`Piece`] writes. `most` affects only
    /// the order of the nodes and blocks.
    pub fn new(mesh: &Mesh, collapse: &Collapse, limits: &Limits, most: usize) -> Result<Self, BuildError> {
        let Some(root) = collapse.root() else {
            return Ok(Self { root: Child::NOTHING, nodes: vec![], blocks: vec![] });
        };
        let defer_up_to = if collapse.references(root).len() > most { most } else { 0 };
        let mut top = Piece::new(mesh, collapse, defer_up_to);
        let root = top.write(root, 0);
        let below = |subtree: &DeferredSubtree| {
            let mut piece = Piece::new(mesh, collapse, 0);
            piece.write(subtree.part, subtree.depth);
            piece
        };
        let pieces: Vec<Piece<T>> = top.deferred.par_iter().map(below).collect();
        Self::joined(root, top, pieces, limits)
    }

    fn joined(root: Child, mut top: Piece<T>, pieces: Vec<Piece<T>>, limits: &Limits) -> Result<Self, BuildError> {
        let whole = || pieces.iter().chain([&top]);
        let nodes = whole().map(|piece| piece.nodes.len()).sum();
        let blocks = whole().map(|piece| piece.blocks.len()).sum();
        limits.check(whole().map(|piece| piece.depth).fold(0, usize::max), nodes, blocks)?;

        let mut starts = vec![];
        let mut end = (top.nodes.len(), top.blocks.len());
        for (subtree, piece) in top.deferred.iter().zip(&pieces) {
            top.nodes[subtree.parent].children[subtree.lane] = Child::node(end.0);
            starts.push(end);
            end = (end.0 + piece.nodes.len(), end.1 + piece.blocks.len());
        }
        let (below, mut blocks_below): (Vec<_>, Vec<_>) =
            pieces.into_iter().map(|piece| (piece.nodes, piece.blocks)).unzip();
        let nodes = || {
            let mut nodes = pages::with_capacity(end.0);
            nodes.append(&mut top.nodes);
            for ((first, block), below) in starts.iter().zip(below) {
                nodes.extend(below.into_iter().map(|node| node.moved(*first, *block)));
            }
            nodes
        };
        let blocks = || {
            let mut blocks = pages::with_capacity(end.1);
            blocks.append(&mut top.blocks);
            blocks_below.iter_mut().for_each(|below| blocks.append(below));
            blocks
        };
        let (nodes, blocks) = rayon::join(nodes, blocks);
        Ok(Self { root, nodes, blocks })
    }
}

struct Piece<'a, T: TriangleTest> {
    mesh: &'a Mesh,
    collapse: &'a Collapse<'a>,
    nodes: Vec<Node>,
    blocks: Vec<LeafBlock<T>>,
    /// Number of nodes on the longest path from the root of the tree into this piece.
    depth: usize,
    /// Subtrees with at most this many references are added to `deferred`.
    defer_up_to: usize,
    deferred: Vec<DeferredSubtree>,
}

/// A subtree that a separate [`Piece`] writes.
struct DeferredSubtree {
    part: Part,
    parent: usize,
    lane: usize,
    /// Number of nodes above the subtree.
    depth: usize,
}

impl<'a, T: TriangleTest> Piece<'a, T> {
    fn new(mesh: &'a Mesh, collapse: &'a Collapse<'a>, defer_up_to: usize) -> Self {
        Self { mesh, collapse, nodes: vec![], blocks: vec![], depth: 0, defer_up_to, deferred: vec![] }
    }

    fn write(&mut self, part: Part, depth: usize) -> Child {
        match part {
            Part::Leaf(_) => self.leaf(part),
            Part::Node(at) => {
                let own = self.nodes.len();
                self.nodes.push(Node::EMPTY);
                self.depth = self.depth.max(depth + 1);
                let children = self.collapse.children(at);
                let mut node = Node { orders: children.orders, ..Node::EMPTY };
                let parts = children.parts();
                for (lane, &part) in (WIDTH - parts.len()..).zip(parts) {
                    let is_left =
                        matches!(part, Part::Node(_)) && self.collapse.references(part).len() <= self.defer_up_to;
                    let child = if is_left {
                        self.deferred.push(DeferredSubtree { part, parent: own, lane, depth: depth + 1 });
                        Child::NOTHING
                    } else {
                        self.write(part, depth + 1)
                    };
                    node.set(lane, self.collapse.bounds(part), child);
                }
                self.nodes[own] = node;
                Child::node(own)
            }
        }
    }

    fn leaf(&mut self, part: Part) -> Child {
        let mut ids = self.collapse.references(part).to_vec();
        ids.sort_unstable();
        ids.dedup();
        let (first, blocks) = (self.blocks.len(), ids.len().div_ceil(WIDTH));
        assert!(blocks <= Child::BLOCKS, "no leaf exceeds the maximum number of blocks");
        LeafBlock::fill(self.mesh, &ids, &mut self.blocks);
        Child::leaf(first, blocks)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::build::Quality;
    use crate::build::check::soup;
    use crate::build::sah_cost::CostModel;
    use crate::build::sbvh::{SbvhConfig, Splits, build};
    use crate::triangle::MollerTrumbore;

    type Tree = Layout<MollerTrumbore>;

    fn seen(tree: &Tree, child: Child, into: &mut Vec<String>) {
        match child.blocks() {
            Some((first, count)) => {
                into.extend(tree.blocks[first..first + count].iter().map(|b| format!("{:?}", b.ids)))
            }
            None => {
                let node = &tree.nodes[child.index()];
                into.push(format!("{:?} {:?}", node.planes, node.orders));
                node.children.iter().for_each(|&child| seen(tree, child, into));
            }
        }
    }

    #[test]
    fn pieces_make_the_tree_that_one_thread_writes_alone() {
        let mesh = soup(20_000, 41);
        for splits in [Splits::Spatial, Splits::SpatialAndObject, Splits::Object] {
            let tree = build(&mesh, &SbvhConfig::new(splits, Quality::Fast));
            let collapse = Collapse::new(&tree, &CostModel::new(1.0, 1.0, 0.0));
            let all = |most: usize| {
                let tree = Tree::new(&mesh, &collapse, &Limits::OF_NODES, most).unwrap();
                let mut into = vec![];
                seen(&tree, tree.root, &mut into);
                (into, tree.nodes.len(), tree.blocks.len())
            };
            let alone = all(usize::MAX);
            assert!(alone.1 > 100, "{}", alone.1);
            for most in [100, 1000, PIECE, 19_999] {
                assert!(all(most) == alone, "{splits:?}, pieces of {most}");
            }
        }
    }
}
