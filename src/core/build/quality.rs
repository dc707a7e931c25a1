use serde::{Deserialize, Serialize};

/// Build time in exchange for a better tree. The numbers are ratios of times on one thread of an Intel Xeon (Sapphire
/// Rapids), for six real meshes of 57,000 to 262,000 triangles, relative to the presets of obvhs' binary tree; speeds
/// are over primary, shadow, diffuse and random rays together.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Quality {
    /// Few candidate planes, selected from few references in larger nodes; with only planes also fewer references and
    /// larger leaves. A build takes 1.0 to 1.7 x as long as obvhs `medium`, with only planes 1.6 to 2.4 x, on two
    /// threads at most 1.9 x. Relative to `Balanced`, builds by groups take 0.8 of the time, by both kinds of splits
    /// 0.6, by planes 0.4; rays have 0.89 to 1.05 of the speed, in the kitchen 0.95, 0.84 and 0.79 to 0.87.
    Fast,
    /// A finer search around the best plane; then parts of the tree move to better places. A build takes 0.15 to 0.92 x
    /// as long as obvhs `very-slow`.
    #[default]
    Balanced,
    /// Slices of triangles instead of boxes (for cells, more planes), and more moves: 0.94 to 1.01 of the SAH cost of
    /// `Balanced`. Builds take 1.0 to 1.2 x as long, with both kinds of splits 1.1 to 1.6 x, with tight boxes of planes
    /// 1.9 to 2.4 x; rays have 0.97 to 1.02 of the speed, for cells in the kitchen 1.05.
    High,
}
