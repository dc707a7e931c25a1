use super::config::SplitConfig;
use crate::structures::extent::Extent;

/// References that a leaf tests at once.
pub(super) const WIDTH: usize = 8;

/// The surface area heuristic on tight boxes: costs are half areas times the cost of what a line that meets the box does.
#[derive(Clone, Copy, Debug)]
pub(super) struct CostModel {
    node: f64,
    block: f64,
}

impl CostModel {
    pub fn new(config: &SplitConfig) -> Self {
        Self { node: config.node_cost.into(), block: config.block_cost.into() }
    }

    /// Of testing `count` triangles in a box.
    #[inline(always)]
    pub fn leaf(&self, area: f64, count: usize) -> f64 {
        area * self.block * count.div_ceil(WIDTH) as f64
    }

    /// Of a box whose children cost `children`.
    #[inline(always)]
    pub fn node(&self, area: f64, children: f64) -> f64 {
        self.node * area + children
    }

    /// Of a box that is cut into two leaves with these areas and counts.
    #[inline(always)]
    pub fn split(&self, area: f64, areas: [f64; 2], counts: [usize; 2]) -> f64 {
        self.node(area, self.leaf(areas[0], counts[0]) + self.leaf(areas[1], counts[1]))
    }
}

/// A cheapest way so far.
#[derive(Clone, Copy, Debug)]
pub(super) struct Offer<T> {
    pub cost: f64,
    pub split: T,
    /// The boxes of both sides, as far as the search knows them.
    pub sides: [Extent; 2],
    /// The references of both sides.
    pub counts: [usize; 2],
}

impl<T> Offer<T> {
    pub fn map<U>(self, name: impl FnOnce(T) -> U) -> Offer<U> {
        Offer { cost: self.cost, split: name(self.split), sides: self.sides, counts: self.counts }
    }
}

/// The cheaper of two, the first where they cost the same.
pub(super) fn cheaper<T>(a: Option<Offer<T>>, b: Option<Offer<T>>) -> Option<Offer<T>> {
    match (a, b) {
        (Some(a), Some(b)) => Some(if b.cost < a.cost { b } else { a }),
        (a, b) => a.or(b),
    }
}
