//! The cells of a tree as tight boxes: what a wide tree is made of.

use super::build::Plan;
use super::clip::clipped_bounds;
use super::node::Node;
use crate::geometry::{Aabb, Mesh};
use crate::structures::binary::{BinaryNode, BinaryTree, Content};

/// References that a leaf may hold; fuller ones are dealt out to several in the same cell.
const MOST: u32 = 64;

/// The leaves of `plan` that hold something, each with the tight box of what its triangles have in its cell, and the inner
/// nodes that are still needed.
pub(super) fn tight(mesh: &Mesh, plan: Plan) -> BinaryTree {
    let Plan { nodes, references, tight } = plan;
    let mut known = tight.into_iter();
    let mut parts: Vec<Part> = nodes
        .iter()
        .map(
            |node| {
                if node.is_leaf() { Part { holds: node.references() > 0, bounds: known.next() } } else { Part::NONE }
            },
        )
        .collect();
    for at in (0..nodes.len()).rev().filter(|&at| !nodes[at].is_leaf()) {
        parts[at].holds = parts[at + 1].holds || parts[nodes[at].above() as usize].holds;
    }

    let tree = BinaryTree { nodes: Vec::with_capacity(nodes.len()), references };
    let mut cells = Cells { mesh, nodes: &nodes, parts: &parts, tree };
    if parts[0].holds {
        cells.visit(0, mesh.bounds());
    }
    cells.tree.nodes.shrink_to_fit();
    cells.tree
}

/// What is known of a node: whether there is anything below it, and the tight box of a leaf.
struct Part {
    holds: bool,
    bounds: Option<Aabb>,
}

impl Part {
    const NONE: Self = Self { holds: false, bounds: None };
}

struct Cells<'a> {
    mesh: &'a Mesh,
    nodes: &'a [Node],
    parts: &'a [Part],
    tree: BinaryTree,
}

impl Cells<'_> {
    /// Appends the subtree at `at`, which is not empty, parents first; its box.
    fn visit(&mut self, at: usize, cell: Aabb) -> Aabb {
        let node = self.nodes[at];
        if node.is_leaf() {
            let (first, count) = (node.first(), node.references());
            return match self.parts[at].bounds {
                Some(bounds) if count <= MOST => self.push(bounds, Content::Leaf { first, count }),
                _ => {
                    let ids = &mut self.tree.references[first as usize..(first + count) as usize];
                    let centre = |&id: &u32| self.mesh.triangle_bounds(id).centre()[cell.longest_axis()];
                    ids.sort_by(|a, b| centre(a).total_cmp(&centre(b)).then(a.cmp(b)));
                    self.deal(first, count, &cell)
                }
            };
        }

        let (below, above) = cell.cut(node.axis(), node.split());
        let (left_at, right_at) = (at + 1, node.above() as usize);
        if !self.parts[right_at].holds {
            return self.visit(left_at, below);
        }
        if !self.parts[left_at].holds {
            return self.visit(right_at, above);
        }
        self.pair(|cells| cells.visit(left_at, below), |cells| cells.visit(right_at, above))
    }

    /// A leaf of references in `cell`, or a subtree where there are too many; its box.
    fn deal(&mut self, first: u32, count: u32, cell: &Aabb) -> Aabb {
        if count <= MOST {
            let ids = &self.tree.references[first as usize..(first + count) as usize];
            let part = |bounds: Aabb, &id: &u32| {
                let corners = self.mesh.corners(id);
                bounds.union(clipped_bounds(corners, cell, &Aabb::of_points(corners)))
            };
            let bounds = ids.iter().fold(Aabb::EMPTY, part);
            return self.push(bounds, Content::Leaf { first, count });
        }
        let half = (count / 2).next_multiple_of(8);
        self.pair(|cells| cells.deal(first, half, cell), |cells| cells.deal(first + half, count - half, cell))
    }

    /// Appends a node and what the closures append below it; its box.
    fn pair(&mut self, left: impl FnOnce(&mut Self) -> Aabb, right: impl FnOnce(&mut Self) -> Aabb) -> Aabb {
        let own = self.tree.nodes.len();
        self.push(Aabb::EMPTY, Content::Inner([0; 2]));
        let below = left(self);
        let second = self.tree.nodes.len() as u32;
        let bounds = below.union(right(self));
        self.tree.nodes[own] = BinaryNode { bounds, content: Content::Inner([own as u32 + 1, second]) };
        bounds
    }

    fn push(&mut self, bounds: Aabb, content: Content) -> Aabb {
        self.tree.nodes.push(BinaryNode { bounds, content });
        bounds
    }
}
