//! Ratios between records, with their intervals. Pure functions: whoever reads records later gets the same.

use crate::measure::{AaNoise, Estimate, Rerun, cut_to_shared_epochs, epoch_values};
use crate::report::Record;

/// The A/A ratios of records: how the twin's times relate to those of the structure that it is the twin of, cell by
/// cell.
pub fn twins(records: &[Record]) -> AaNoise {
    AaNoise::new(&records.iter().filter_map(Record::speed_against_twin).collect::<Vec<_>>())
}

/// The geometric mean of how many times faster the first of each pair is than the second, with its
/// [interval](mod@crate::measure::interval), over the epochs that all pairs have. Nothing where one of them has no time, or their samples
/// are not of the same rounds.
pub fn speed<'a>(pairs: impl IntoIterator<Item = (&'a Record, &'a Record)>, noise: &AaNoise) -> Option<Estimate> {
    let cells: Option<Vec<_>> = pairs.into_iter().map(|(own, other)| own.speed_against(other)).collect();
    let mut cells = cells?;
    // Where time ran out, scenes have different numbers of them.
    cut_to_shared_epochs(&mut cells);
    Some(Rerun::of(&epoch_values(&cells)?, noise.of_mean(cells.len()))?.ratio())
}
