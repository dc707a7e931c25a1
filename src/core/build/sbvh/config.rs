use crate::build::quality::Quality;
use crate::build::sah_cost::CostModel;

/// [`Splits::SpatialAndObject`] tries spatial splits only if the children of the best object split overlap by more than
/// this share of the root's area. The paper uses 1e-5; a larger share builds faster.
pub(super) const ALPHA: f32 = 1e-3;

/// An object split that competes with a spatial split costs extra: this factor times the cost of testing the smaller
/// side's triangles in the overlap of both boxes. 0 in the paper; values from 2 to 10 give equally fast trees.
pub(super) const OVERLAP_COST: f32 = 3.0;

/// Maximum number of references of a leaf.
pub(super) const LEAF: usize = 64;

/// The configuration of a binary tree of tight boxes. [`SbvhConfig::new`] has the tuned values.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct SbvhConfig {
    pub splits: Splits,
    /// Number of candidate planes, and of bins, per axis; in 2..=62. More find cheaper splits and take longer.
    pub candidates: u32,
    /// Nodes with at most this many references try every object split; larger nodes use bins.
    pub exact: u32,
    /// Nodes with at most this many references clip triangles to find spatial splits; larger nodes cut only boxes.
    pub sliced: u32,
    /// Nodes with at least this many references refine the search around the best plane of a spatial split.
    pub refined: u32,
    /// Maximum number of references in the sample that a larger node searches for a split. At least 16.
    pub sample: u32,
    /// Cost of a binary step, relative to a block test. Positive. An eight-wide step replaces about three binary steps.
    pub node_cost: f32,
    /// Maximum number of references of the tree, as a multiple of the number of triangles. At least 1.
    pub duplication: f32,
}

/// The splits that a builder may use.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Splits {
    /// Spatial splits. Leaves are disjoint, except if no plane can divide the references of a large leaf.
    Spatial,
    /// Spatial or object splits, whichever is cheaper.
    SpatialAndObject,
    /// Object splits. Every triangle is in one leaf.
    Object,
}

impl SbvhConfig {
    pub const fn new(splits: Splits, quality: Quality) -> Self {
        let spatial = matches!(splits, Splits::Spatial);
        let (candidates, exact, sliced, refined, sample) = match quality {
            Quality::Fast => (if spatial { 8 } else { 12 }, 0, 0, u32::MAX, 1024),
            Quality::Balanced => (20, 16, 0, 16, 16384),
            Quality::High => (20, 16, 4096, 16, 16384),
        };
        // With only spatial splits, cutting takes most of the time. A higher cost gives larger leaves and fewer cuts.
        let node_cost = match quality {
            Quality::Fast if spatial => 1.5,
            Quality::Fast => 0.4,
            Quality::Balanced | Quality::High => 0.3,
        };
        Self { splits, candidates, exact, sliced, refined, sample, node_cost, duplication: 4.0 }
    }

    pub(super) fn costs(&self) -> CostModel {
        CostModel::new(self.node_cost, 1.0, 0.0)
    }
}
