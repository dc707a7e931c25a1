//! The cost model of the surface area heuristic.

use crate::geometry::Aabb;
use crate::triangle::BLOCK;

/// Expected cost of a tree for a random line through the root box (Goldsmith, Salmon 1987; MacDonald, Booth 1990). The
/// empty-space bonus comes from Wald and Havran (2006). The cost of a leaf is proportional to its number of blocks.
#[derive(Clone, Copy, Debug)]
pub(crate) struct CostModel {
    step: f64,
    /// Cost of the test of one block of triangles.
    block: f64,
    /// A split that cuts off empty space saves this share of the cost.
    empty_bonus: f64,
}

impl CostModel {
    pub fn new(step: f32, block: f32, empty_bonus: f32) -> Self {
        Self { step: step.into(), block: block.into(), empty_bonus: empty_bonus.into() }
    }

    #[inline(always)]
    pub fn leaf(&self, count: usize) -> f64 {
        self.block * count.div_ceil(BLOCK) as f64
    }

    /// Cost of a cell that is cut at `plane` into two leaves.
    #[inline(always)]
    pub fn cell_split(&self, cell: &SideAreas, plane: f32, [below, above]: [usize; 2]) -> f64 {
        let [below_area, above_area] = cell.at(plane.into());
        let areas = (below_area * self.leaf(below) + above_area * self.leaf(above)) * cell.inverse;
        let cost = self.step + areas;
        if below == 0 || above == 0 { cost * (1.0 - self.empty_bonus) } else { cost }
    }

    /// Cost of a leaf, multiplied by the half area of the leaf's box.
    #[inline(always)]
    pub fn box_leaf(&self, area: f64, count: usize) -> f64 {
        area * self.block * count.div_ceil(BLOCK) as f64
    }

    /// Cost of a subtree, multiplied by the half area of the subtree's box. `children` is the sum of the results of
    /// `box_leaf` or `box_node` for the children.
    #[inline(always)]
    pub fn box_node(&self, area: f64, children: f64) -> f64 {
        self.step * area + children
    }

    /// Cost of a node with two leaves, multiplied by the half area of the node's box.
    #[inline(always)]
    pub fn box_split(&self, area: f64, areas: [f64; 2], counts: [usize; 2]) -> f64 {
        self.box_node(area, self.box_leaf(areas[0], counts[0]) + self.box_leaf(areas[1], counts[1]))
    }
}

/// Half areas of both sides of a cell, as linear functions of the split coordinate.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SideAreas {
    min: f64,
    max: f64,
    caps: f64,
    girth: f64,
    /// The reciprocal of the half area of the cell.
    inverse: f64,
}

impl SideAreas {
    pub fn new(cell: &Aabb, axis: usize) -> Self {
        let extent = cell.max.as_dvec3() - cell.min.as_dvec3();
        let (u, v) = (extent[(axis + 1) % 3], extent[(axis + 2) % 3]);
        let (min, max) = (f64::from(cell.min[axis]), f64::from(cell.max[axis]));
        let (caps, girth) = (u * v, u + v);
        Self { min, max, caps, girth, inverse: 1.0 / (caps + (max - min) * girth) }
    }

    #[inline(always)]
    fn at(&self, split: f64) -> [f64; 2] {
        [self.caps + (split - self.min) * self.girth, self.caps + (self.max - split) * self.girth]
    }
}
