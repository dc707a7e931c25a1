use serde::{Deserialize, Serialize};

use super::batch::Batch;
use crate::accel::BuildError;
use crate::geometry::Mesh;
use crate::structures::binary::BinaryTree;
use crate::structures::kd::{self, KdConfig};
use crate::structures::reinsert::reinsert;
use crate::structures::split::{self, Quality, SplitConfig, Splits};

/// How a [`WideTree`](super::WideTree) is built. What differs between `sah-kd-wide`, `sah-kd-tight`, `sah-hybrid` and `sah-bvh` is the
/// partition alone.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct WideConfig {
    /// How the triangles are divided.
    pub partition: Partition,
    /// How much time a build may take for a better tree.
    pub quality: Quality,
    /// Cost of testing a block of eight triangles, where visiting a node costs 1. Positive; more gives smaller leaves.
    pub block_cost: f32,
    /// References a build may make, as a multiple of the triangles, with [`Quality::Fast`] at most 1.75: the guard against inputs
    /// that explode. At least 1.
    pub duplication: f32,
    /// How the rays of a slice are answered.
    pub batch: Batch,
}

/// How the triangles of a scene are divided, by the surface area heuristic.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Partition {
    /// The cells of `sah-kd`, of which the tight boxes are kept.
    Cells,
    /// By planes, the heuristic computed on tight boxes.
    Tight,
    /// By planes or by groups of triangles, whichever is cheaper (Stich, Friedrich, Dietrich 2009).
    Hybrid,
    /// By groups of triangles: a bounding volume hierarchy.
    Objects,
}

impl WideConfig {
    /// The values measured for a partition.
    pub const fn new(partition: Partition) -> Self {
        Self { partition, quality: Quality::Balanced, block_cost: 1.0, duplication: 2.4, batch: Batch::Single }
    }

    pub(super) fn check(&self) -> Result<(), BuildError> {
        let refuse = |what: &str| Err(BuildError::Config(what.into()));
        if !(self.block_cost > 0.0 && self.block_cost.is_finite()) {
            return refuse("block_cost must be a positive number");
        }
        if !(self.duplication >= 1.0 && self.duplication.is_finite()) {
            return refuse("duplication must be a number of at least 1");
        }
        Ok(())
    }

    /// Divides the triangles of `mesh`.
    pub(super) fn divide(&self, mesh: &Mesh) -> Result<BinaryTree, BuildError> {
        // Trees without object splits have twice the nodes and less to gain.
        let passes = match (self.quality, self.partition) {
            (Quality::Fast, Partition::Objects) => 2,
            (Quality::Fast, _) => 0,
            (Quality::Balanced, Partition::Objects | Partition::Hybrid) => 4,
            (Quality::Balanced, _) => 3,
            (Quality::High, _) => 8,
        };
        // Making references is what takes the time where planes cut triangles.
        let duplication = if self.quality == Quality::Fast { self.duplication.min(1.75) } else { self.duplication };
        let splits = match self.partition {
            Partition::Cells => {
                let config = KdConfig { duplication, ..KdConfig::cells(self.quality) };
                return Ok(reinsert(kd::partition(mesh, &config)?, passes));
            }
            Partition::Tight => Splits::Spatial,
            Partition::Hybrid => Splits::SpatialAndObject,
            Partition::Objects => Splits::Object,
        };
        let config = SplitConfig { duplication, ..SplitConfig::new(splits, self.quality) };
        config.check()?;
        Ok(reinsert(split::build(mesh, &config), passes))
    }
}

impl Default for WideConfig {
    fn default() -> Self {
        Self::new(Partition::Hybrid)
    }
}
