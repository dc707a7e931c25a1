use serde::{Deserialize, Serialize};

use crate::accel::BuildError;

/// How a binary tree of tight boxes is built. [`SplitConfig::new`] has the values that were measured.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SplitConfig {
    /// Which splits are allowed.
    pub splits: Splits,
    /// Candidate planes and bins of an axis, in 2..=62; more finds cheaper splits and takes longer.
    pub candidates: u32,
    /// Nodes of at most this many references try every object split; larger ones try `candidates`. The cheapest of all splits is
    /// not the best for the tree: 64 in place of 16 costs 2 to 8 % more by the heuristic in the end.
    pub exact: u32,
    /// Nodes of at most this many references see the clipped triangle in every slab of a spatial split; larger ones see its
    /// box cut by the slab.
    pub chopped: u32,
    /// Nodes of at least this many references look closer around the best plane of a spatial split.
    pub refined: u32,
    /// Of larger nodes, only about so many references tell where to split. At least 16.
    pub sample: u32,
    /// Spatial splits beside object splits are tried where the children of the best object split overlap by more than this
    /// share of the root's area, in [0, 1]. Stich, Friedrich, Dietrich use 1e-5; more makes fewer references
    /// and takes less time: 1e-4 in place of the preset's 1e-3 builds 1.2 to 1.3 times as long, for the same speed.
    pub alpha: f32,
    /// Cost of a step from a node to its two children. Positive; more gives bigger leaves. A step of an 8-wide tree is about
    /// three of these.
    pub node_cost: f32,
    /// Cost of testing a block of eight triangles. Positive; more gives smaller leaves.
    pub block_cost: f32,
    /// References that a leaf may hold, in 8..=64.
    pub leaf: u32,
    /// References a build may make, as a multiple of the triangles: the guard against inputs that explode. At least 1.
    pub duplication: f32,
}

/// Which splits a builder may use.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Splits {
    /// By planes: the leaves are disjoint.
    Spatial,
    /// By planes or by groups, whichever is cheaper.
    SpatialAndObject,
    /// By groups: every triangle is in one leaf.
    Object,
}

/// How much time a build may take for a better tree. Ratios are of times on one thread of an Intel Xeon (Sapphire Rapids), for six real
/// meshes of 57,000 to 262,000 triangles, against the presets of obvhs' binary tree; speeds are of primary, shadow, diffuse and random rays
/// together.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Quality {
    /// Few candidates, few references that tell where to split a larger node; with planes alone also fewer references and larger leaves.
    /// 1.0 to 1.7 times obvhs `medium`, with planes alone 1.6 to 2.4, on two threads at most 1.9 times. Groups build in 0.8 of the time of
    /// `Balanced`, both kinds of splits in 0.6, planes in 0.4; rays are 0.89 to 1.05 times as fast, in the kitchen 0.95, 0.84 and 0.79 to 0.87.
    Fast,
    /// A closer look around the best plane, then parts of the tree move to better places. 0.15 to 0.92 times obvhs `very-slow`.
    #[default]
    Balanced,
    /// Slices of triangles instead of boxes (for cells, more planes), more moves: by the heuristic 0.94 to 1.01 times the cost of `Balanced`.
    /// Builds in 1.0 to 1.2 times the time, both kinds of splits in 1.1 to 1.6 and tight boxes of planes in 1.9 to 2.4; rays are 0.97 to 1.02
    /// times as fast, but for cells in the kitchen (1.05).
    High,
}

impl SplitConfig {
    /// The values measured for `quality`.
    pub const fn new(splits: Splits, quality: Quality) -> Self {
        let spatial = matches!(splits, Splits::Spatial);
        let (candidates, exact, chopped, refined, sample) = match quality {
            Quality::Fast => (if spatial { 8 } else { 12 }, 0, 0, u32::MAX, 1024),
            Quality::Balanced => (20, 16, 0, 16, 16384),
            Quality::High => (20, 16, 4096, 16, 16384),
        };
        // What costs time where only planes may split is making references: a fast build makes fewer, and larger leaves.
        let node_cost = match quality {
            Quality::Fast if spatial => 1.5,
            Quality::Fast => 0.4,
            Quality::Balanced | Quality::High => 0.3,
        };
        Self {
            splits,
            candidates,
            exact,
            chopped,
            refined,
            sample,
            alpha: 1e-3,
            node_cost,
            block_cost: 1.0,
            leaf: 64,
            duplication: 4.0,
        }
    }

    /// # Errors
    /// If a value is out of its range, naming it.
    pub fn check(&self) -> Result<(), BuildError> {
        let refuse = |what: &str| Err(BuildError::Config(what.into()));
        let positive = |x: f32| x > 0.0 && x.is_finite();
        if !(2..=62).contains(&self.candidates) {
            return refuse("candidates must be in 2..=62");
        }
        if self.sample < 16 {
            return refuse("sample must be at least 16");
        }
        if !(0.0..=1.0).contains(&self.alpha) {
            return refuse("alpha must be in 0..=1");
        }
        if !positive(self.node_cost) || !positive(self.block_cost) {
            return refuse("node_cost and block_cost must be positive numbers");
        }
        if !(8..=64).contains(&self.leaf) {
            return refuse("leaf must be in 8..=64");
        }
        if !(self.duplication >= 1.0 && self.duplication.is_finite()) {
            return refuse("duplication must be a number of at least 1");
        }
        Ok(())
    }
}
