//! The node graph of a glTF file.

use glam::DMat4;
use gltf::{Document, Node};

use super::placement::local;
use crate::scene::load::error::Fault;

const DEEPEST: usize = 1024;

/// Returns the shown nodes, and the transforms of all nodes to world space.
///
/// The shown nodes are the nodes of the default scene. If the file has no default scene, all nodes are shown.
/// Their order is depth-first, with each node before its children.
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
    let is_root = |node: &Node| parents[node.index()].is_none();
    let file_roots = nodes.iter().filter(|node| is_root(node)).cloned();
    let roots: Vec<Node> = match document.default_scene() {
        Some(scene) => scene.nodes().collect(),
        None => file_roots.clone().collect(),
    };

    // `waiting` is a stack. The shown roots lie on top, to be visited before the hidden roots.
    let entry = |node, is_shown| (node, DMat4::IDENTITY, 1, is_shown);
    let mut waiting: Vec<_> = file_roots.map(|root| entry(root, false)).collect();
    waiting.extend(roots.into_iter().rev().map(|root| entry(root, true)));
    let mut worlds = vec![None; nodes.len()];
    let mut shown = Vec::new();
    while let Some((node, above, depth, is_shown)) = waiting.pop() {
        let number = node.index();
        if is_shown && (worlds[number].is_some() || depth == 1 && !is_root(&node)) {
            return fault(number, "the scene lists it twice, or another node does: list only roots, once".to_owned());
        }
        if depth > DEEPEST {
            return fault(number, format!("it lies deeper than {DEEPEST} nodes: flatten the hierarchy"));
        }
        if worlds[number].is_none() {
            let world = above * local(&node);
            worlds[number] = Some(world);
            let first = waiting.len();
            waiting.extend(node.children().map(|child| (child, world, depth + 1, is_shown)));
            waiting[first..].reverse();
            shown.extend(is_shown.then_some(node));
        }
    }
    if let Some(node) = worlds.iter().position(Option::is_none) {
        return fault(node, "it is its own ancestor: remove the cycle".to_owned());
    }
    Ok((shown, worlds.into_iter().flatten().collect()))
}
