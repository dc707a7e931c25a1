//! The node graph of a glTF file.

use glam::{DMat4, DQuat, DVec3};

use super::document::{Document, Node};
use crate::scene::load::error::Fault;

/// Deeper graphs are rejected.
const DEEPEST: usize = 1024;

pub(super) struct Placement {
    pub node: usize,
    pub mesh: usize,
    pub transform: DMat4,
}

/// The meshes of the default scene, or of all roots when the file names no default scene, in the order of a walk that
/// visits a node before its children.
///
/// # Errors
/// A graph that is not a forest: a node with two parents, a cycle, a scene that shows a node twice or names one that is
/// no root; or a graph deeper than 1024 nodes.
pub(super) fn placements(document: &Document) -> Result<Vec<Placement>, Fault> {
    let nodes = &document.nodes;
    let mut parent: Vec<Option<usize>> = vec![None; nodes.len()];
    for (number, node) in nodes.iter().enumerate() {
        for &child in &node.children {
            if let Some(first) = parent[child].replace(number) {
                let problem = format!("it is a child of node {first} and of node {number}: give it one parent");
                return Err(Fault::part(format!("node {child}"), problem));
            }
        }
    }
    let roots = || (0..nodes.len()).filter(|&n| parent[n].is_none());
    let seen = walk(nodes, roots(), |_, _, _| ())?;
    if let Some(number) = seen.iter().position(|seen| !seen) {
        return Err(Fault::part(format!("node {number}"), "it is its own ancestor: remove the cycle"));
    }

    if let Some(scene) = document.scene {
        let shown = &document.scenes[scene].nodes;
        if let Some(at) = shown.iter().position(|&node| parent[node].is_some()) {
            let problem = format!("node {} is a child of another one: list roots only", shown[at]);
            return Err(Fault::part(format!("scenes[{scene}].nodes[{at}]"), problem));
        }
    }

    let mut placements = Vec::new();
    let place = |number: usize, node: &Node, transform| {
        if let Some(mesh) = node.mesh {
            placements.push(Placement { node: number, mesh, transform });
        }
    };
    match document.scene {
        Some(scene) => walk(nodes, document.scenes[scene].nodes.iter().copied(), place)?,
        None => walk(nodes, roots(), place)?,
    };
    Ok(placements)
}

/// Visits the nodes below `roots` with their transforms to world space. Returns which were visited.
fn walk(
    nodes: &[Node],
    roots: impl Iterator<Item = usize>,
    mut visit: impl FnMut(usize, &Node, DMat4),
) -> Result<Vec<bool>, Fault> {
    let mut seen = vec![false; nodes.len()];
    let mut waiting: Vec<(usize, DMat4, usize)> = roots.map(|n| (n, DMat4::IDENTITY, 1)).collect();
    waiting.reverse();
    while let Some((number, above, depth)) = waiting.pop() {
        if std::mem::replace(&mut seen[number], true) {
            return Err(Fault::part(format!("node {number}"), "the scene shows it twice: list roots only, each once"));
        }
        if depth > DEEPEST {
            let problem = format!("it lies deeper than {DEEPEST} nodes: flatten the hierarchy");
            return Err(Fault::part(format!("node {number}"), problem));
        }
        let node = &nodes[number];
        let transform = above * local(node);
        visit(number, node, transform);
        let first = waiting.len();
        waiting.extend(node.children.iter().map(|&child| (child, transform, depth + 1)));
        waiting[first..].reverse();
    }
    Ok(seen)
}

fn local(node: &Node) -> DMat4 {
    if let Some(matrix) = node.matrix {
        return DMat4::from_cols_array(&matrix.map(f64::from));
    }
    let vector = |v: Option<[f32; 3]>, default| v.map_or(default, |v| DVec3::from(v.map(f64::from)));
    // A unit quaternion in f32 is not of unit length in f64.
    let rotation = node.rotation.map_or(DQuat::IDENTITY, |r| DQuat::from_array(r.map(f64::from)));
    let length = rotation.length();
    let rotation = if length > 0.0 && length.is_finite() { rotation / length } else { DQuat::IDENTITY };
    DMat4::from_scale_rotation_translation(
        vector(node.scale, DVec3::ONE),
        rotation,
        vector(node.translation, DVec3::ZERO),
    )
}
