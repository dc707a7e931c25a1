use serde::{Deserialize, Serialize};

use crate::accel::BuildError;
use crate::build::cells::{CellConfig, Rules};
use crate::build::sah_cost::CostModel;

/// The options of a [`KdTree`](super::KdTree). "The report" is the student report that sahara reproduces. An option
/// without effect must have its value in [`REPORT`](Self::REPORT) or in [`SAH`](Self::SAH).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct KdConfig {
    /// The position of a split.
    pub plane: Plane,
    /// The axis of a median.
    pub axis: AxisRule,
    /// The condition for a leaf.
    pub stop: Stop,
    /// The traversal algorithm.
    pub traversal: Traversal,
    /// For [`Stop::Report`] and [`Stop::Leaf`]: a node with fewer triangles is a leaf. At least 1.
    pub leaf: u32,
    /// Whether a node of exactly `leaf` triangles may be split.
    pub limit: Limit,
    /// For [`Stop::Report`]: a split is discarded if its children share at least this fraction of triangles. In (0, 1].
    pub threshold: f32,
    /// The triangles to which the fraction `threshold` refers.
    pub count: CountOf,
    /// The definition of the median of vertex coordinates or centroids.
    pub median: Median,
    /// The children that receive a triangle with a vertex in the split plane.
    pub equal: Equal,
    /// When the traversal of a ray stops.
    pub exit: Exit,
    /// Whether each ray has a small hashed mailbox. A ray does not test a triangle again while its mailbox contains the
    /// triangle.
    pub mailbox: bool,
    /// SAH cost of an inner node. Must be positive.
    pub traversal_cost: f32,
    /// SAH cost of a block of eight triangles. Must be positive.
    pub intersection_cost: f32,
    /// Fraction of its cost that a split saves if it cuts off empty space, in [0, 1). Wald and Havran use 0.2.
    pub empty_bonus: f32,
    /// Maximum number of references, as a multiple of the number of triangles. At least 1.
    pub duplication: f32,
}

/// The position of a split.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Plane {
    /// The median of the vertex coordinates of the node's triangles.
    VertexMedian,
    /// The middle of the cell.
    SpatialMedian,
    /// The median of the centroids of the node's triangles.
    CentroidMedian,
    /// The plane of least SAH cost of 32 per axis (Hunt, Mark, Stoll 2006). Large nodes use a sample of triangles.
    SahBinned,
    /// The plane of least SAH cost among all faces of the boxes of clipped triangles.
    SahSweep,
}

/// The axis of a median split.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum AxisRule {
    /// Depth modulo 3.
    Cyclic,
    /// The longest axis of the cell.
    Longest,
}

/// The rule that makes a node a leaf. Every node is also a leaf at depth 8 + 1.3 log2 n, or if its split would exceed
/// `duplication`. With a median, a third split in a row without progress is replaced by a leaf.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Stop {
    /// Fewer than `leaf` triangles, or a split whose children share at least the fraction `threshold` of triangles.
    Report,
    /// Fewer than `leaf` triangles.
    Leaf,
    /// By SAH cost, the selected split is not cheaper than testing all triangles.
    Sah,
}

/// The traversal algorithm.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Traversal {
    /// Test the boxes of both children, as the report does.
    ChildBoxes,
    /// Cut the ray's interval at the plane.
    PlaneIntervals,
}

/// The comparison of a node's number of triangles with `leaf`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Limit {
    /// A leaf has fewer than `leaf` triangles.
    Below,
    /// A leaf has at most `leaf` triangles.
    AtMost,
}

/// The triangles to which the fraction `threshold` refers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum CountOf {
    /// The triangles of the node. A split that reaches the threshold is discarded.
    Parent,
    /// The triangles of each child. A child that reaches the threshold is not split further.
    Child,
}

/// The median of an even number of values, and how often a shared corner counts.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Median {
    /// The lower of the two middle values. A corner that triangles share counts once per triangle.
    Lower,
    /// The mean of the two middle values. A corner that triangles share counts once per triangle.
    Mean,
    /// The lower of the two middle values. A corner that triangles share counts once.
    Welded,
}

/// The children that receive a triangle with a vertex in the split plane.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Equal {
    /// Both children. Only a triangle strictly below or strictly above the plane goes to a single child.
    Both,
    /// The child below if no vertex is above the plane, otherwise both children.
    Below,
}

/// When the traversal of a ray stops.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Exit {
    /// When no nearer hit can follow.
    Nearest,
    /// After the first leaf with a hit at any distance, as the report literally says. Nearer hits may be lost.
    FirstLeaf,
}

impl KdConfig {
    /// The report's tree: `median-kd`.
    pub const REPORT: Self = Self {
        plane: Plane::VertexMedian,
        axis: AxisRule::Cyclic,
        stop: Stop::Report,
        traversal: Traversal::ChildBoxes,
        leaf: 100,
        limit: Limit::Below,
        threshold: 0.7,
        count: CountOf::Parent,
        median: Median::Lower,
        equal: Equal::Both,
        exit: Exit::Nearest,
        mailbox: false,
        traversal_cost: 1.0,
        intersection_cost: 1.0,
        empty_bonus: 0.0,
        duplication: 100.0,
    };

    /// The tree of Wald and Havran: `sah-kd`.
    pub const SAH: Self = Self {
        plane: Plane::SahSweep,
        stop: Stop::Sah,
        traversal: Traversal::PlaneIntervals,
        traversal_cost: 1.0,
        intersection_cost: 0.7,
        empty_bonus: 0.2,
        duplication: 8.0,
        ..Self::REPORT
    };

    pub(super) fn rules(&self) -> Rules {
        let leaf = match (self.stop, self.limit) {
            (Stop::Sah, _) => 1,
            (Stop::Report | Stop::Leaf, Limit::Below) => self.leaf as usize - 1,
            (Stop::Report | Stop::Leaf, Limit::AtMost) => self.leaf as usize,
        };
        Rules {
            leaf,
            threshold: (self.stop == Stop::Report).then_some(self.threshold),
            pays: self.stop == Stop::Sah,
            duplication: self.duplication,
            one_side_is_progress: self.plane == Plane::SpatialMedian,
        }
    }

    /// The configuration of the search for the cheapest plane.
    pub(super) fn sah(&self) -> CellConfig {
        let exact = if self.plane == Plane::SahSweep { CellConfig::ALL_PLANES } else { 0 };
        CellConfig { costs: self.costs(), exact, candidates: 32, sample: 16384 }
    }

    pub(super) fn costs(&self) -> CostModel {
        CostModel::new(self.traversal_cost, self.intersection_cost, self.empty_bonus)
    }

    pub(super) fn check(&self) -> Result<(), BuildError> {
        let positive = |x: f32| x > 0.0 && x.is_finite();
        let demands = [
            (self.leaf >= 1, "leaf must be at least 1"),
            (self.threshold > 0.0 && self.threshold <= 1.0, "threshold must be above 0 and at most 1"),
            (
                positive(self.traversal_cost) && positive(self.intersection_cost),
                "traversal_cost and intersection_cost must be positive numbers",
            ),
            ((0.0..1.0).contains(&self.empty_bonus), "empty_bonus must be at least 0 and below 1"),
            (self.duplication >= 1.0 && self.duplication.is_finite(), "duplication must be a number of at least 1"),
        ];
        if let Some((_, sentence)) = demands.iter().find(|(is_met, _)| !is_met) {
            return Err(BuildError::Config((*sentence).into()));
        }
        self.check_unread()
    }

    fn check_unread(&self) -> Result<(), BuildError> {
        let is_median = !matches!(self.plane, Plane::SahBinned | Plane::SahSweep);
        let asks_costs = !is_median || self.stop == Stop::Sah;
        macro_rules! refuse_unread {
            ($($key:ident: $is_read:expr, $with:literal;)*) => {$(
                if !$is_read && ![Self::REPORT.$key, Self::SAH.$key].contains(&self.$key) {
                    let fault = "has no effect here, so it must keep its default; it is used only with";
                    return Err(BuildError::Config(format!("{} {fault} {}", stringify!($key), $with)));
                }
            )*};
        }
        refuse_unread! {
            axis: is_median, "plane=vertex-median, spatial-median or centroid-median";
            median: is_median && self.plane != Plane::SpatialMedian, "plane=vertex-median or plane=centroid-median";
            equal: is_median, "plane=vertex-median, spatial-median or centroid-median";
            leaf: self.stop != Stop::Sah, "stop=report or stop=leaf";
            limit: self.stop != Stop::Sah, "stop=report or stop=leaf";
            threshold: self.stop == Stop::Report, "stop=report";
            count: self.stop == Stop::Report && is_median,
                "stop=report and with plane=vertex-median, spatial-median or centroid-median";
            traversal_cost: asks_costs, "plane=sah-binned, plane=sah-sweep or stop=sah";
            intersection_cost: asks_costs, "plane=sah-binned, plane=sah-sweep or stop=sah";
            empty_bonus: asks_costs, "plane=sah-binned, plane=sah-sweep or stop=sah";
        }
        Ok(())
    }
}

impl Default for KdConfig {
    fn default() -> Self {
        Self::SAH
    }
}
