//! `parameters`: the report's sweep of its leaf limit and match threshold; which differences are real?
//!
//! The report prints single runs. Here every setting is built anew in several epochs and timed in interleaved rounds on all rays
//! of the picture, the setting of the report's main table twice: what these twins differ by is the A/A noise. Cube has fewer
//! triangles than every leaf limit, so that all its settings are the same tree: the control.

mod result;
mod table;
#[cfg(test)]
mod tests;

use super::replicate::original::{MAIN, SWEEP, SweepRow};
use crate::registry::{Choice, ChoiceError, Registry};
use crate::study::baselines::REPORT_TREE;

pub use result::{Parameters, Setting, Verdict, result, rows};
pub use table::tables;

/// Name of the study, and of its journal; a case is an [`Epoch`](super::epoch::Epoch).
pub const NAME: &str = "parameters";

/// The setting of the report's main table: the others are held against it.
pub const DEFAULT: (u32, f32) = (100, 0.7);

/// Names of the scenes of the report's sweep.
pub fn scenes() -> Vec<&'static str> {
    MAIN.iter().map(|row| row.scene).collect()
}

/// The number of the default in the sweep.
pub(super) fn default_row() -> usize {
    SWEEP.iter().position(is_default).expect("the sweep holds the default")
}

fn is_default(row: &SweepRow) -> bool {
    (row.leaf, row.threshold) == DEFAULT
}

/// The settings of the sweep in their order, then the twin of the default.
///
/// # Errors
/// If the report's tree is not registered as the sweep expects.
pub fn structures(registry: &Registry) -> Result<Vec<Choice>, ChoiceError> {
    let rows = SWEEP.iter().chain([&SWEEP[default_row()]]);
    let spec = |row: &SweepRow| format!("{REPORT_TREE}:leaf={},threshold={}", row.leaf, row.threshold);
    rows.map(|row| registry.choose(&spec(row))).collect()
}
