use serde::{Deserialize, Serialize};

use crate::accel::BuildError;
use crate::build::Quality;
use crate::build::binary_tree::BinaryTree;
use crate::build::cells::{self, CellConfig};
use crate::build::reinsert::reinsert;
use crate::build::sbvh::{self, SbvhConfig, Splits};
use crate::geometry::Mesh;
use crate::triangle::TriangleTest;

/// How a [`Bvh8`](super::Bvh8) is built. What differs between `sah-kd-wide`, `sah-kd-tight`, `sah-hybrid` and `sah-bvh`
/// is the partition alone.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Bvh8Config {
    /// How the triangles are divided.
    pub partition: Partition,
    /// How much time a build may take for a better tree.
    pub quality: Quality,
    /// Cost of testing a block of eight triangles, where visiting a node costs 1. Positive; more gives smaller leaves.
    pub block_cost: f32,
    /// References a build may make, as a multiple of the triangles, with [`Quality::Fast`] at most 1.75: the guard
    /// against inputs that explode. At least 1.
    pub duplication: f32,
    /// How the rays of a slice are answered; [`Batch::Single`] over tests that are not
    /// [`BATCHED`](TriangleTest::BATCHED).
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

/// How the rays of a slice are answered, always with the same answers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Batch {
    /// One after the other.
    Single,
    /// Sixteen in a row travel together where they share an octant. Of the others eight are under way at a time or one
    /// follows the other, whichever was faster on the last ones of which both were tried.
    Packets,
}

impl Bvh8Config {
    /// The values measured for a partition.
    pub const fn new(partition: Partition) -> Self {
        Self { partition, quality: Quality::Balanced, block_cost: 1.0, duplication: 2.4, batch: Batch::Single }
    }

    pub(super) fn check<T: TriangleTest>(&self) -> Result<(), BuildError> {
        let refuse = |what: &str| Err(BuildError::Config(what.into()));
        if !(self.block_cost > 0.0 && self.block_cost.is_finite()) {
            return refuse("block_cost must be a positive number");
        }
        if !(self.duplication >= 1.0 && self.duplication.is_finite()) {
            return refuse("duplication must be a number of at least 1");
        }
        if self.batch != Batch::Single && !T::BATCHED {
            return refuse("batch must be single over this triangle test");
        }
        Ok(())
    }

    /// Partitions the triangles of `mesh`.
    pub(super) fn partition(&self, mesh: &Mesh) -> BinaryTree {
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
        let boxes = |splits| sbvh::build(mesh, &SbvhConfig { duplication, ..SbvhConfig::new(splits, self.quality) });
        let tree = match self.partition {
            Partition::Cells => cells::build(mesh, &CellConfig::new(self.quality), duplication),
            Partition::Tight => boxes(Splits::Spatial),
            Partition::Hybrid => boxes(Splits::SpatialAndObject),
            Partition::Objects => boxes(Splits::Object),
        };
        reinsert(tree, passes)
    }
}

impl Default for Bvh8Config {
    fn default() -> Self {
        Self::new(Partition::Hybrid)
    }
}
