use serde::{Deserialize, Serialize};

use crate::accel::BuildError;
use crate::build::cells::{CellConfig, Rules};
use crate::build::sah_cost::CostModel;

/// The options of a [`KdTree`](super::KdTree). "The report" is the student report that sahara reproduces.
///
/// If an option has no effect, its value must equal the value in [`REPORT`](Self::REPORT) or [`SAH`](Self::SAH).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct KdConfig {
    /// The position of a split.
    pub plane: Plane,
    /// The axis of a median split.
    pub axis: AxisRule,
    /// The condition for a leaf.
    pub stop: Stop,
    /// The traversal algorithm.
    pub traversal: Traversal,
    /// With [`Stop::Report`] or [`Stop::Leaf`], a node with fewer than `leaf` triangles is a leaf.
    /// Must be at least 1.
    pub leaf: u32,
    /// Whether a node of exactly `leaf` triangles may be split, which the report does not specify.
    pub limit: Limit,
    /// [`Stop::Report`] makes a leaf if at least this fraction of triangles would be in both children.
    /// Must be in (0, 1].
    pub threshold: f32,
    /// The triangles to which the fraction `threshold` refers.
    pub count: CountOf,
    /// The definition of the median of vertex coordinates or centroids.
    pub median: Median,
    /// The children that receive a triangle with a vertex in the split plane.
    pub equal: Equal,
    /// When the traversal of a ray stops.
    pub exit: Exit,
    /// Whether each ray has a small hashed mailbox. Blocks whose triangles are all in the mailbox are not tested again.
    pub mailbox: bool,
    /// SAH cost of an inner node. Must be positive.
    pub traversal_cost: f32,
    /// SAH cost of a block of eight triangles. Must be positive.
    pub intersection_cost: f32,
    /// An empty child reduces the SAH cost of a split by this fraction, in [0, 1). Wald and Havran use 0.2.
    pub empty_bonus: f32,
    /// Maximum number of references, as a multiple of the number of triangles. Must be at least 1.
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
    /// The plane of least SAH cost of at most 34 per axis, including both ends (Hunt, Mark, Stoll 2006).
    /// In large nodes, a sample of triangles estimates the cost.
    SahBinned,
    /// The plane of least SAH cost among all faces of the boxes of clipped triangles.
    SahSweep,
}

/// The axis of a median split.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum AxisRule {
    /// The number of the axis is the depth of the node modulo 3.
    Cyclic,
    /// The longest axis of the cell.
    Longest,
}

/// The condition for a leaf. A depth limit of about 8 + 1.3 log2 n and `duplication` also make leaves. With a median, a
/// node is also a leaf if its split would be the third in a row without progress.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Stop {
    /// The options `leaf` and `threshold` determine the leaves.
    Report,
    /// The option `leaf` determines the leaves.
    Leaf,
    /// A node is a leaf if the chosen split would not reduce the SAH cost.
    Sah,
}

/// The traversal algorithm.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Traversal {
    /// Intersects the ray with the boxes of both children, as the report does.
    ChildBoxes,
    /// Cuts the interval of the ray at the split plane.
    PlaneIntervals,
}

/// The comparison of a node's number of triangles with `leaf`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Limit {
    /// A node with fewer than `leaf` triangles is a leaf.
    Below,
    /// A node with at most `leaf` triangles is a leaf.
    AtMost,
}

/// The triangles to which the fraction `threshold` refers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum CountOf {
    /// The triangles of the node. If the fraction reaches `threshold`, the split is discarded.
    Parent,
    /// The triangles of each child. If the fraction reaches `threshold`, the child is not split.
    Child,
}

/// The definition of the median of vertex coordinates or centroids.
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
    /// Both children.
    Both,
    /// If another vertex is above the plane, both children. Otherwise only the child below the plane.
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
