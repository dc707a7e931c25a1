//! Inputs and results of the searches for a split.

use super::config::SbvhConfig;
use crate::build::extent::Extent;
use crate::build::sah_cost::CostModel;
use crate::geometry::Mesh;
use crate::triangle::BLOCK;

/// A box is large if its half area exceeds this share of the root's half area. Few boxes are large, so their additional
/// splits are cheap.
const LARGE: f64 = 1.0 / 2048.0;

pub(super) struct Context<'a> {
    pub mesh: &'a Mesh,
    pub config: &'a SbvhConfig,
    pub costs: CostModel,
    pub root_area: f64,
    /// From this depth on, nodes with too many references for a leaf are halved. Every build therefore terminates.
    pub depth: u32,
}

impl<'a> Context<'a> {
    pub fn new(mesh: &'a Mesh, config: &'a SbvhConfig) -> Self {
        let root_area = Extent::from(mesh.bounds()).half_area();
        let depth = 16 + 2 * (usize::BITS - mesh.len().leading_zeros());
        Self { mesh, config, costs: config.costs(), root_area, depth }
    }

    /// A block of triangles in a large box may be split, because many rays visit the box.
    pub fn is_large(&self, area: f64) -> bool {
        area > LARGE * self.root_area
    }

    /// The cost of a leaf, for comparison with the cost of a split. The cost of a leaf of one block in a large box
    /// includes a traversal step. This step cancels the traversal step of the split node. The split adds a child
    /// to the wide node above, but no wide node.
    pub fn unsplit_cost(&self, area: f64, count: usize) -> f64 {
        let leaf = self.costs.box_leaf(area, count);
        if count <= BLOCK && self.is_large(area) { self.costs.box_node(area, leaf) } else { leaf }
    }
}

#[derive(Clone, Copy, Debug)]
pub(super) struct Offer<T> {
    pub cost: f64,
    pub split: T,
    /// The boxes of both sides, possibly only of sampled references.
    pub sides: [Extent; 2],
    /// The numbers of references on both sides, possibly estimated from a sample.
    pub counts: [usize; 2],
}

impl<T> Offer<T> {
    pub fn map<U>(self, name: impl FnOnce(T) -> U) -> Offer<U> {
        Offer { cost: self.cost, split: name(self.split), sides: self.sides, counts: self.counts }
    }
}

/// If the costs are equal, `a` wins.
pub(super) fn cheaper<T>(a: Option<Offer<T>>, b: Option<Offer<T>>) -> Option<Offer<T>> {
    match (a, b) {
        (Some(a), Some(b)) => Some(if b.cost < a.cost { b } else { a }),
        (a, b) => a.or(b),
    }
}
