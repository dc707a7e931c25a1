//! The cost model of the surface area heuristic.

use super::WIDTH;
use super::config::KdConfig;
use crate::geometry::Aabb;

/// Expected cost of a cell for a random line that meets it (MacDonald, Booth 1990), with the empty-space bonus of Wald and
/// Havran (2006). Leaves test a block of triangles at once, so a leaf costs by the block: counting
/// triangles instead gave trees of the same speed and 40 % more memory.
#[derive(Clone, Copy, Debug)]
pub(super) struct CostModel {
    traversal: f64,
    intersection: f64,
    empty_bonus: f64,
}

impl CostModel {
    pub fn new(config: &KdConfig) -> Self {
        Self {
            traversal: config.traversal_cost.into(),
            intersection: config.intersection_cost.into(),
            empty_bonus: config.empty_bonus.into(),
        }
    }

    /// The cost of testing `count` triangles.
    #[inline(always)]
    pub fn leaf(&self, count: usize) -> f64 {
        self.intersection * count.div_ceil(WIDTH) as f64
    }

    /// The cost of a cell with half area `1 / inverse_area` whose sides become leaves.
    #[inline(always)]
    pub fn split(
        &self,
        inverse_area: f64,
        (below_area, below): (f64, usize),
        (above_area, above): (f64, usize),
    ) -> f64 {
        let areas = (below_area * self.leaf(below) + above_area * self.leaf(above)) * inverse_area;
        let cost = self.traversal + areas;
        if below == 0 || above == 0 { cost * (1.0 - self.empty_bonus) } else { cost }
    }
}

/// Half areas of both sides of a cell, as linear functions of the split coordinate.
#[derive(Clone, Copy, Debug)]
pub(super) struct SideAreas {
    min: f64,
    max: f64,
    caps: f64,
    girth: f64,
}

impl SideAreas {
    pub fn new(cell: &Aabb, axis: usize) -> Self {
        let extent = cell.max.as_dvec3() - cell.min.as_dvec3();
        let (u, v) = (extent[(axis + 1) % 3], extent[(axis + 2) % 3]);
        Self { min: cell.min[axis].into(), max: cell.max[axis].into(), caps: u * v, girth: u + v }
    }

    #[inline(always)]
    pub fn at(&self, split: f64) -> (f64, f64) {
        (self.caps + (split - self.min) * self.girth, self.caps + (self.max - split) * self.girth)
    }

    pub fn whole(&self) -> f64 {
        self.caps + (self.max - self.min) * self.girth
    }
}
