//! The cells of a tree as tight boxes: what a wide tree is made of.

use super::build::Plan;
use super::clip::clipped_bounds;
use super::node::Node;
use crate::geometry::{Aabb, Mesh};
use crate::structures::binary::{BinaryNode, BinaryTree, Content};

/// The leaves of `plan` that hold something, each with the tight box of what its triangles have in its cell, and the inner
/// nodes that are still needed.
pub(super) fn tight(mesh: &Mesh, plan: Plan) -> BinaryTree {
    let Plan { nodes, references } = plan;
    let mut holds = vec![false; nodes.len()];
    for (at, node) in nodes.iter().enumerate().rev() {
        holds[at] = if node.is_leaf() { node.references() > 0 } else { holds[at + 1] || holds[node.above() as usize] };
    }
    let mut tree = BinaryTree { nodes: Vec::with_capacity(nodes.len()), references };
    if holds[0] {
        visit(mesh, &nodes, &holds, 0, mesh.bounds(), &mut tree);
    }
    tree
}

/// Appends the subtree at `at`, which is not empty, parents first; its box.
fn visit(mesh: &Mesh, nodes: &[Node], holds: &[bool], at: usize, cell: Aabb, tree: &mut BinaryTree) -> Aabb {
    let node = nodes[at];
    let own = tree.nodes.len();
    if node.is_leaf() {
        let (first, count) = (node.first(), node.references());
        let ids = &tree.references[first as usize..(first + count) as usize];
        let part = |bounds: Aabb, &id: &u32| {
            let corners = mesh.corners(id);
            bounds.union(clipped_bounds(corners, &cell, &Aabb::of_points(corners)))
        };
        let bounds = ids.iter().fold(Aabb::EMPTY, part);
        tree.nodes.push(BinaryNode { bounds, content: Content::Leaf { first, count } });
        return bounds;
    }

    let (below, above) = cell.cut(node.axis(), node.split());
    let (left_at, right_at) = (at + 1, node.above() as usize);
    if !holds[right_at] {
        return visit(mesh, nodes, holds, left_at, below, tree);
    }
    if !holds[left_at] {
        return visit(mesh, nodes, holds, right_at, above, tree);
    }
    tree.nodes.push(BinaryNode { bounds: Aabb::EMPTY, content: Content::Inner([0; 2]) });
    let left = visit(mesh, nodes, holds, left_at, below, tree);
    let second = tree.nodes.len() as u32;
    let right = visit(mesh, nodes, holds, right_at, above, tree);
    let bounds = left.union(right);
    tree.nodes[own] = BinaryNode { bounds, content: Content::Inner([own as u32 + 1, second]) };
    bounds
}
