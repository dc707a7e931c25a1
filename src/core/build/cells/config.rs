use crate::build::quality::Quality;
use crate::build::sah_cost::CostModel;

/// How the cheapest cut of a cell is searched.
#[derive(Clone, Copy, Debug)]
pub(crate) struct CellConfig {
    pub costs: CostModel,
    /// Nodes of at most this many references try every plane.
    pub exact: u32,
    /// Planes that larger nodes try on an axis, in 2..=62.
    pub candidates: u32,
    /// Of larger nodes, only about so many references tell where to cut. At least 16.
    pub sample: u32,
}

impl CellConfig {
    /// Every plane of every node.
    pub const ALL_PLANES: u32 = u32::MAX;

    /// The cells that a wide tree is made of: cheap steps, since three of them are one step of that tree, and all
    /// planes only where nodes are small or never. In larger nodes the cheapest of all often cuts off empty space,
    /// which a tight box does without: by the heuristic the finished tree costs 0.94 to 0.98 as much with 8 in place of
    /// 65,536 in the highest preset. 24 builds a little faster than 8.
    pub fn new(quality: Quality) -> Self {
        let (exact, candidates, sample, step) = match quality {
            Quality::Fast => (0, 12, 512, 1.0),
            Quality::Balanced => (24, 24, 16384, 0.2),
            Quality::High => (8, 62, 1 << 16, 0.2),
        };
        Self { costs: CostModel::new(step, 0.7, 0.2), exact, candidates, sample }
    }
}
