use serde::{Deserialize, Serialize};

/// Build quality: slower builds give better trees.
///
/// The numbers are ratios on one thread of an Intel Xeon (Sapphire Rapids), for six real meshes of 57,000 to 262,000
/// triangles; the smallest mesh is `kitchen`. Build times are relative to a preset of obvhs' binary tree or to
/// `Balanced`. Speeds are over primary, shadow, diffuse and random rays together. Names such as `Cells` are
/// [partitioning strategies](crate::bvh8::Partition).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Quality {
    /// Few candidate planes, selected from few references in larger nodes; `Cells` and `Tight` also make fewer
    /// references and larger leaves.
    ///
    /// | partition | build time / obvhs `medium` | build time / `Balanced` | speed / `Balanced`, in `kitchen` |
    /// |---|---|---|---|
    /// | `Objects` | 1.0 to 1.7 | 0.8 | 0.95 |
    /// | `Hybrid` | 1.0 to 1.7 | 0.6 | 0.84 |
    /// | `Cells`, `Tight` | 1.6 to 2.4 | 0.4 | 0.79 to 0.87 |
    ///
    /// In the other meshes rays have 0.89 to 1.05 of the speed of `Balanced`. On two threads, builds take at most 1.9 x
    /// as long as obvhs `medium`.
    Fast,
    /// A finer search around the best plane; then subtrees are reinserted where they reduce the SAH cost. A build takes
    /// 0.15 to 0.92 x as long as obvhs `very-slow`.
    #[default]
    Balanced,
    /// Spatial splits of smaller nodes clip triangles to slabs instead of cutting their boxes (`Cells`: more candidate
    /// planes), and reinsertion has more passes. The SAH cost is 0.94 to 1.01 of the cost of `Balanced`. Builds take
    /// 1.0 to 1.2 x as long as with `Balanced` (`Hybrid`: 1.1 to 1.6 x, `Tight`: 1.9 to 2.4 x); rays have 0.97 to 1.02
    /// of the speed (`Cells` in `kitchen`: 1.05).
    High,
}
