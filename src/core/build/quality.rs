use serde::{Deserialize, Serialize};

/// Build quality: slower builds give better trees.
///
/// Build times and ray rates are ratios to `Balanced` or to a preset of obvhs' binary tree, for six real meshes of
/// 57,000 to 262,000 triangles on one thread of an Intel Xeon (Sapphire Rapids). `Cells`, `Tight`, `Hybrid` and
/// `Objects` are [partitioning strategies](crate::bvh8::Partition).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Quality {
    /// Few candidate planes, small samples of larger nodes, and at most 1.75 references per triangle. `Cells` and
    /// `Tight` also make larger leaves. A build takes 0.4 (`Cells`, `Tight`), 0.6 (`Hybrid`) or 0.8 x (`Objects`) as
    /// long as with `Balanced`, and 1.0 to 2.4 x as long as obvhs `medium`. Rays are traced 0.79 to 1.05 x as fast.
    Fast,
    /// A finer search, and reinsertion with every strategy. A build takes 0.15 to 0.92 x as long as obvhs `very-slow`.
    #[default]
    Balanced,
    /// Spatial splits of smaller nodes clip triangles instead of cutting their boxes; `Cells` has more candidate planes
    /// instead. Reinsertion has more passes. The SAH cost is 0.94 to 1.01 of the cost of `Balanced`. Builds take
    /// 1.0 to 2.4 x as long; rays are traced 0.97 to 1.05 x as fast.
    High,
}
