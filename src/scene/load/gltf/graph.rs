//! The node graph of a glTF file.

use glam::DMat4;
use gltf::{Document, Node};

use super::placement::{Placement, local};
use super::text::Instances;
use crate::scene::load::error::Fault;

/// Deeper graphs are rejected.
const DEEPEST: usize = 1024;

/// The meshes of the default scene, or of all roots when the file names no default scene, in the order of a walk that
/// visits a node before its children; and the transforms of all nodes to world space.
///
/// # Errors
/// A graph that is not a forest: a node with two parents, a cycle, a scene that shows a node twice or names one that is
/// no root; or a graph deeper than 1024 nodes.
pub(super) fn placements<'a>(
    document: &'a Document,
    instances: &Instances,
) -> Result<(Vec<Placement<'a>>, Vec<DMat4>), Fault> {
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
    let shown: Vec<usize> = match document.default_scene() {
        Some(scene) => scene.nodes().map(|node| node.index()).collect(),
        None => (0..nodes.len()).filter(|&node| is_root(node)).collect(),
    };
    let mut is_shown = vec![false; nodes.len()];
    for &node in &shown {
        if std::mem::replace(&mut is_shown[node], true) {
            return fault(node, "the scene shows it twice: list roots only, each once".to_owned());
        }
    }

    // Visit all nodes, those that are shown first.
    let hidden = (0..nodes.len()).filter(|&node| !is_shown[node]);
    let roots = hidden.chain(shown.iter().rev().copied()).filter(|&node| is_root(node));
    let mut waiting: Vec<(usize, DMat4, usize)> = roots.map(|node| (node, DMat4::IDENTITY, 1)).collect();
    let mut worlds = vec![None; nodes.len()];
    let mut placements = Vec::new();
    while let Some((number, above, depth)) = waiting.pop() {
        if depth > DEEPEST {
            return fault(number, format!("it lies deeper than {DEEPEST} nodes: flatten the hierarchy"));
        }
        let node = &nodes[number];
        let world = above * local(node.transform());
        worlds[number] = Some(world);
        if let Some(mesh) = node.mesh().filter(|_| is_shown[number]) {
            let instances = instances.get(&number).copied().unwrap_or_default();
            placements.push(Placement { node: number, world, mesh, skin: node.skin(), instances });
        }
        let first = waiting.len();
        for child in node.children().map(|child| child.index()) {
            is_shown[child] = is_shown[number];
            waiting.push((child, world, depth + 1));
        }
        waiting[first..].reverse();
    }
    if let Some(node) = worlds.iter().position(Option::is_none) {
        return fault(node, "it is its own ancestor: remove the cycle".to_owned());
    }
    if let (Some(scene), Some(i)) = (document.default_scene(), shown.iter().position(|&node| !is_root(node))) {
        let problem = format!("node {} is a child of another one: list roots only", shown[i]);
        return Err(Fault::part(format!("scenes[{}].nodes[{i}]", scene.index()), problem));
    }
    Ok((placements, worlds.into_iter().flatten().collect()))
}
