use crate::build::quality::Quality;
use crate::build::sah_cost::CostModel;

/// [`Splits::SpatialAndObject`] tries spatial splits only if the children of the best object split overlap by more than
/// this share of the root's area. The paper uses 1e-5; a larger share builds faster.
pub(super) const ALPHA: f32 = 1e-3;

/// Extra cost of an object split that competes with a spatial split: this multiple of the cost of testing the smaller
/// side's triangles in the overlap of both sides. 0 in the paper; values from 2 to 10 give equally fast trees.
pub(super) const OVERLAP_COST: f32 = 3.0;

/// Maximum number of references of a leaf.
pub(super) const LEAF: usize = 64;

/// The configuration of a binary tree of tight boxes. [`SbvhConfig::new`] has the tuned values.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct SbvhConfig {
    pub splits: Splits,
    /// Candidate planes and bins per axis, in 2..=62; more candidates find cheaper splits and take longer.
    pub candidates: u32,
    /// Nodes with at most this many references try every object split; larger ones try `candidates`.
    pub exact: u32,
    /// Nodes with at most this many references clip triangles to the slabs of a spatial split; larger nodes cut boxes.
    pub sliced: u32,
    /// Nodes with at least this many references refine the search around the best plane of a spatial split.
    pub refined: u32,
    /// A larger node uses a sample of at most this many references. At least 16.
    pub sample: u32,
    /// Cost of a binary step, in blocks of triangles; positive. A step of an eight-wide tree is about three of them.
    pub node_cost: f32,
    /// Maximum number of references of the tree, as a multiple of the triangles. At least 1.
    pub duplication: f32,
}

/// The splits that a builder may use.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Splits {
    /// By planes: leaves are disjoint, except if no plane can divide the references of a large leaf.
    Spatial,
    /// By planes or into groups, whichever is cheaper.
    SpatialAndObject,
    /// Into groups: every triangle is in one leaf.
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
        // If only planes split, making references takes most of the time: a fast build makes fewer, and larger leaves.
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
