use crate::build::quality::Quality;
use crate::build::sah_cost::CostModel;

#[derive(Clone, Copy, Debug)]
pub(crate) struct CellConfig {
    pub costs: CostModel,
    /// Nodes of at most this many references try every plane.
    pub exact: u32,
    /// Planes per axis that larger nodes try, in 2..=62.
    pub candidates: u32,
    /// Maximum number of references in the sample of a larger node; at least 16.
    pub sample: u32,
}

impl CellConfig {
    pub const ALL_PLANES: u32 = u32::MAX;

    /// The configuration for a wide tree. A step costs little, because three binary steps become one wide step.
    pub fn new(quality: Quality) -> Self {
        let (exact, candidates, sample, step) = match quality {
            Quality::Fast => (0, 12, 512, 1.0),
            Quality::Balanced => (24, 24, 16384, 0.2),
            Quality::High => (8, 62, 1 << 16, 0.2),
        };
        Self { costs: CostModel::new(step, 0.7, 0.2), exact, candidates, sample }
    }
}
