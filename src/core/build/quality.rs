use serde::{Deserialize, Serialize};

/// How much time a build may take for a better tree. Ratios are of times on one thread of an Intel Xeon (Sapphire
/// Rapids), for six real meshes of 57,000 to 262,000 triangles, against the presets of obvhs' binary tree; speeds are
/// of primary, shadow, diffuse and random rays together.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Quality {
    /// Few candidates, few references that tell where to split a larger node; with planes alone also fewer references
    /// and larger leaves. 1.0 to 1.7 times obvhs `medium`, with planes alone 1.6 to 2.4, on two threads at most 1.9
    /// times. Groups build in 0.8 of the time of `Balanced`, both kinds of splits in 0.6, planes in 0.4; rays are 0.89
    /// to 1.05 times as fast, in the kitchen 0.95, 0.84 and 0.79 to 0.87.
    Fast,
    /// A closer look around the best plane, then parts of the tree move to better places. 0.15 to 0.92 times obvhs
    /// `very-slow`.
    #[default]
    Balanced,
    /// Slices of triangles instead of boxes (for cells, more planes), more moves: by the heuristic 0.94 to 1.01 times
    /// the cost of `Balanced`. Builds in 1.0 to 1.2 times the time, both kinds of splits in 1.1 to 1.6 and tight boxes
    /// of planes in 1.9 to 2.4; rays are 0.97 to 1.02 times as fast, but for cells in the kitchen (1.05).
    High,
}
