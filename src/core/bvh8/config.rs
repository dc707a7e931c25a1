use serde::{Deserialize, Serialize};

use crate::accel::BuildError;
use crate::build::Quality;
use crate::build::binary_tree::BinaryTree;
use crate::build::cells::{self, CellConfig};
use crate::build::reinsert::reinsert;
use crate::build::sbvh::{self, SbvhConfig, Splits};
use crate::geometry::Mesh;
use crate::triangle::TriangleTest;

/// The build options of a [`Bvh8`](super::Bvh8).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Bvh8Config {
    /// The partitioning strategy.
    pub partition: Partition,
    /// The build quality.
    pub quality: Quality,
    /// SAH cost of testing eight triangles, relative to the cost of visiting a node. Must be positive and finite.
    pub block_cost: f32,
    /// Maximum mean number of references per triangle. Must be at least 1. [`Quality::Fast`] uses at most 1.75.
    pub duplication: f32,
    /// How a slice of rays is traced. Must be [`Batch::Single`] if the triangle test is not
    /// [`BATCHED`](TriangleTest::BATCHED).
    pub batch: Batch,
}

/// A partitioning strategy by the surface area heuristic.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Partition {
    /// The cells of the KD-tree `sah-kd`, stored as tight boxes.
    Cells,
    /// Spatial splits only, with the heuristic computed on tight boxes.
    Tight,
    /// Spatial and object splits: an SBVH (Stich, Friedrich, Dietrich 2009).
    Hybrid,
    /// Object splits only: a BVH without duplicated references.
    Objects,
}

/// How a slice of rays is traced. All variants find the same hits.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Batch {
    /// One ray after the other.
    Single,
    /// Sixteen consecutive rays with directions in one octant may form a packet. In trees larger than 2 MiB,
    /// closest-hit queries may interleave rays that form no packet. At most eight rays are interleaved at a time.
    Packets,
}

impl Bvh8Config {
    /// The default options for a partition.
    pub const fn new(partition: Partition) -> Self {
        Self { partition, quality: Quality::Balanced, block_cost: 1.0, duplication: 2.4, batch: Batch::Single }
    }

    pub(super) fn check<T: TriangleTest>(&self) -> Result<(), BuildError> {
        let demands = [
            (self.block_cost > 0.0 && self.block_cost.is_finite(), "block_cost must be a positive number"),
            (self.duplication >= 1.0 && self.duplication.is_finite(), "duplication must be a number of at least 1"),
            (self.batch == Batch::Single || T::BATCHED, "batch must be `single` with this triangle test"),
        ];
        let unmet = demands.iter().find(|(is_met, _)| !is_met);
        unmet.map_or(Ok(()), |(_, sentence)| Err(BuildError::Config((*sentence).into())))
    }

    pub(super) fn partition(&self, mesh: &Mesh) -> BinaryTree {
        let passes = match (self.quality, self.partition) {
            (Quality::Fast, Partition::Objects) => 2,
            (Quality::Fast, _) => 0,
            (Quality::Balanced, Partition::Objects | Partition::Hybrid) => 4,
            (Quality::Balanced, _) => 3,
            (Quality::High, _) => 8,
        };
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
