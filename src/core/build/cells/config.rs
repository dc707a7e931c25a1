use crate::build::quality::Quality;
use crate::build::sah_cost::CostModel;

#[derive(Clone, Copy, Debug)]
pub(crate) struct CellConfig {
    pub costs: CostModel,
    /// A node with at most this many references tries a plane at each face of the references' boxes.
    pub exact: u32,
    /// Maximum number of planes per axis for nodes with more than `exact` references, in 2..=62. Planes on the
    /// faces of the node's bounds are not counted.
    pub candidates: u32,
    /// Maximum number of references in the sample of a node, at least 16.
    pub sample: u32,
}

impl CellConfig {
    pub const ALL_PLANES: u32 = u32::MAX;

    /// The configuration for a wide tree. A wide step replaces about three binary steps, so `step` is only 0.2. Fast
    /// builds use 1, which gives larger leaves. Large nodes do not try all planes, because their cheapest plane often
    /// cuts off only empty space.
    pub fn new(quality: Quality) -> Self {
        let (exact, candidates, sample, step) = match quality {
            Quality::Fast => (0, 12, 512, 1.0),
            Quality::Balanced => (24, 24, 16384, 0.2),
            Quality::High => (8, 62, 1 << 16, 0.2),
        };
        Self { costs: CostModel::new(step, 0.7, 0.2), exact, candidates, sample }
    }
}
