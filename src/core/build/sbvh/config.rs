use crate::build::quality::Quality;
use crate::build::sah_cost::CostModel;

/// If the overlap of the best object split is at most this value, no spatial split is tried. The unit is the half area
/// of the root. Stich et al. (2009) use 1e-5. A larger value makes builds faster.
pub(super) const ALPHA: f32 = 1e-3;

/// Factor in the extra cost of an object split whose boxes overlap. The paper has no such cost. Values from 2 to 10
/// give equally fast trees.
pub(super) const OVERLAP_COST: f32 = 3.0;

/// Maximum number of references in a leaf.
pub(super) const LEAF: usize = 64;

#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct SbvhConfig {
    pub splits: Splits,
    /// Number of candidate planes or bins per axis. In 2..=62.
    pub candidates: u32,
    /// In nodes with at most this many references, object splits are found by sorting instead of binning.
    pub exact: u32,
    /// Nodes with at most this many references clip triangles to find spatial splits. Larger nodes clip only boxes.
    pub sliced: u32,
    /// If a search samples at least this many references, a second search tries planes near the best plane.
    pub refined: u32,
    /// Maximum number of references in a sample. At least 16.
    pub sample: u32,
    /// Cost of a traversal step in the binary tree, relative to the test of one block. Positive. An eight-wide step
    /// replaces about three binary steps.
    pub node_cost: f32,
    /// Maximum number of references in the tree, as a multiple of the number of triangles. At least 1.
    pub duplication: f32,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Splits {
    /// An object split is only a fallback for a node with more than `LEAF` references. Without this fallback, leaves
    /// are disjoint.
    Spatial,
    SpatialAndObject,
    /// No triangle is in two leaves.
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
        // With only spatial splits, cutting takes most of the build time. A higher node cost leads to fewer cuts.
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
