//! Grows the tree of a configuration.

use super::config::{KdConfig, Plane};
use super::median::Triangles;
use super::node::{Limits, Node};
use crate::accel::BuildError;
use crate::build::cells::{Binned, Content, Context, Tree, grow};
use crate::build::cut::Cut;
use crate::geometry::Mesh;

#[derive(Default)]
pub(super) struct Plan {
    pub nodes: Vec<Node>,
    pub references: Vec<u32>,
}

/// Grows the tree of `config`, if it stays within the limits.
pub(super) fn plan(mesh: &Mesh, config: &KdConfig, limits: &Limits) -> Result<Plan, BuildError> {
    config.check()?;
    // Every triangle takes at least one reference: reject a hopeless build at once.
    limits.check(1, mesh.solid().count())?;
    let rules = config.rules();
    let plan: Plan = match config.plane {
        Plane::VertexMedian | Plane::SpatialMedian | Plane::CentroidMedian => {
            let context = Context::new(mesh, rules, config);
            grow(&context, Triangles::all(&context))
        }
        Plane::SahBinned | Plane::SahSweep => {
            let sah = config.sah();
            let context = Context::new(mesh, rules, &sah);
            grow(&context, Binned::all(&context))
        }
    };
    // The numbers in nodes only grow: if the last one fits, all of them fit.
    limits.check(plan.nodes.len(), plan.references.len())?;
    Ok(plan)
}

impl<C: Content> Tree<C> for Plan {
    const SKIPS_EMPTY: bool = false;

    fn len(&self) -> usize {
        self.nodes.len()
    }

    fn leaf(&mut self, content: C) {
        self.nodes.push(Node::leaf(self.references.len() as u32, content.len() as u32));
        self.references.extend(content.ids());
    }

    fn open(&mut self) {
        self.nodes.push(Node::leaf(0, 0));
    }

    fn close(&mut self, inner: usize, cut: Cut, second: usize) {
        self.nodes[inner] = Node::inner(cut.axis, cut.plane, second as u32);
    }

    fn append(&mut self, other: Self) {
        let (nodes, references) = (self.nodes.len() as u32, self.references.len() as u32);
        self.nodes.extend(other.nodes.into_iter().map(|node| {
            if node.is_leaf() {
                Node::leaf(node.first() + references, node.references())
            } else {
                Node::inner(node.axis(), node.split(), node.above() + nodes)
            }
        }));
        self.references.extend(other.references);
    }
}
