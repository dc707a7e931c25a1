use crate::build::quality::Quality;
use crate::build::sah_cost::CostModel;

/// How a binary tree of tight boxes is built. [`SbvhConfig::new`] has the values that were measured.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct SbvhConfig {
    /// Which splits are allowed.
    pub splits: Splits,
    /// Candidate planes and bins of an axis, in 2..=62; more finds cheaper splits and takes longer.
    pub candidates: u32,
    /// Nodes of at most this many references try every object split; larger ones try `candidates`. The cheapest of all
    /// splits is not the best for the tree: 64 in place of 16 costs 2 to 8 % more by the heuristic in the end.
    pub exact: u32,
    /// Nodes of at most this many references see the clipped triangle in every slab of a spatial split; larger ones see
    /// its box cut by the slab.
    pub sliced: u32,
    /// Nodes of at least this many references look closer around the best plane of a spatial split.
    pub refined: u32,
    /// Of larger nodes, only about so many references tell where to split. At least 16.
    pub sample: u32,
    /// Spatial splits beside object splits are tried where the children of the best object split overlap by more than
    /// this share of the root's area, in [0, 1]. Stich, Friedrich, Dietrich use 1e-5; more makes fewer references and
    /// takes less time: 1e-4 in place of the preset's 1e-3 builds 1.2 to 1.3 times as long, for the same speed.
    pub alpha: f32,
    /// What the common part of the boxes of an object split costs, beside spatial splits, as a multiple of testing
    /// there the triangles of the smaller side. At least 0, as in the paper; between 2 and 10 trees are equally fast.
    pub overlap_cost: f32,
    /// Cost of a step from a node to its two children. Positive; more gives bigger leaves. A step of an 8-wide tree is
    /// about three of these.
    pub node_cost: f32,
    /// Cost of testing a block of eight triangles. Positive; more gives smaller leaves.
    pub block_cost: f32,
    /// References that a leaf may hold, in 8..=64.
    pub leaf: u32,
    /// References a build may make, as a multiple of the triangles: the guard against inputs that explode. At least 1.
    pub duplication: f32,
}

/// Which splits a builder may use.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Splits {
    /// By planes: the leaves are disjoint.
    Spatial,
    /// By planes or by groups, whichever is cheaper.
    SpatialAndObject,
    /// By groups: every triangle is in one leaf.
    Object,
}

impl SbvhConfig {
    /// The values measured for `quality`.
    pub const fn new(splits: Splits, quality: Quality) -> Self {
        let spatial = matches!(splits, Splits::Spatial);
        let (candidates, exact, sliced, refined, sample) = match quality {
            Quality::Fast => (if spatial { 8 } else { 12 }, 0, 0, u32::MAX, 1024),
            Quality::Balanced => (20, 16, 0, 16, 16384),
            Quality::High => (20, 16, 4096, 16, 16384),
        };
        // What costs time where only planes may split is making references: a fast build makes fewer, and larger
        // leaves.
        let node_cost = match quality {
            Quality::Fast if spatial => 1.5,
            Quality::Fast => 0.4,
            Quality::Balanced | Quality::High => 0.3,
        };
        Self {
            splits,
            candidates,
            exact,
            sliced,
            refined,
            sample,
            alpha: 1e-3,
            overlap_cost: 3.0,
            node_cost,
            block_cost: 1.0,
            leaf: 64,
            duplication: 4.0,
        }
    }

    pub(super) fn costs(&self) -> CostModel {
        CostModel::new(self.node_cost, self.block_cost, 0.0)
    }
}
