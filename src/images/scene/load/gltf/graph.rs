//! The node graph of a glTF file.

use glam::DMat4;
use gltf::{Document, Node};

use super::placement::local;
use crate::scene::load::error::Fault;

/// Deeper graphs are rejected.
const DEEPEST: usize = 1024;

/// The nodes of the default scene, or of all roots when the file names no default scene, in the order of a walk that
/// visits a node before its children; and the transforms of all nodes to world space.
///
/// # Errors
/// A graph that is not a forest: a node with two parents, a cycle, a scene that shows a node twice or names one that is
/// no root; or a graph deeper than 1024 nodes.
pub(super) fn walk(document: &Document) -> Result<(Vec<Node<'_>>, Vec<DMat4>), Fault> {
    let fault = |node: usize, problem: String| Err(Fault::part(format!("node {node}"), problem));
    let nodes: Vec<Node> = document.nodes().collect();
    let mut parents: Vec<Option<usize>> = vec![None; nodes.len()];
    for node in &nodes {
        for child in node.children().map(|child| child.index()) {
            if let Some(first) = parents[child].replace(node.index()) {
                let problem = format!("it is a child of node {first} and of node {}: give it one parent", node.index());
                return fault(child, problem);
            }
        }
    }
    let is_root = |node: usize| parents[node].is_none();
    let roots: Vec<usize> = match document.default_scene() {
        Some(scene) => scene.nodes().map(|node| node.index()).collect(),
        None => (0..nodes.len()).filter(|&node| is_root(node)).collect(),
    };
    let mut is_shown = vec![false; nodes.len()];
    for &root in &roots {
        if !is_root(root) || std::mem::replace(&mut is_shown[root], true) {
            return fault(root, "the scene lists it twice, or another node does: list only roots, once".to_owned());
        }
    }

    // Visit the shown nodes, then the hidden ones. The last entry of `waiting` is visited first.
    let hidden = (0..nodes.len()).filter(|&node| !is_shown[node]);
    let mut waiting: Vec<usize> = hidden.chain(roots.iter().rev().copied()).filter(|&node| is_root(node)).collect();
    let mut worlds = vec![DMat4::IDENTITY; nodes.len()];
    // 0 for a node that is not yet visited.
    let mut depths = vec![0; nodes.len()];
    let mut shown = Vec::new();
    while let Some(number) = waiting.pop() {
        let node = &nodes[number];
        let (mut above, mut depth) = (DMat4::IDENTITY, 1);
        if let Some(parent) = parents[number] {
            (above, depth) = (worlds[parent], depths[parent] + 1);
            is_shown[number] = is_shown[parent];
        }
        worlds[number] = above * local(node);
        depths[number] = depth;
        if depth > DEEPEST {
            return fault(number, format!("it lies deeper than {DEEPEST} nodes: flatten the hierarchy"));
        }
        shown.extend(is_shown[number].then(|| node.clone()));
        let first = waiting.len();
        waiting.extend(node.children().map(|child| child.index()));
        waiting[first..].reverse();
    }
    if let Some(node) = depths.iter().position(|depth| *depth == 0) {
        return fault(node, "it is its own ancestor: remove the cycle".to_owned());
    }
    Ok((shown, worlds))
}
