//! Ratios between records, with their intervals. Pure functions: whoever reads records later gets the same.

use crate::measure::{AaNoise, Estimate, Rerun, epoch_values};
use crate::report::Record;

/// The A/A ratios of records: how the twin's times relate to those of the structure that it is the twin of, cell by
/// cell.
pub fn twins(records: &[Record]) -> AaNoise {
    AaNoise::new(&records.iter().filter_map(Record::speed_against_twin).collect::<Vec<_>>())
}

/// The geometric mean of how many times faster the first of each pair is than the second, with its
/// [interval](mod@crate::measure::interval). Nothing where one of them has no time, or their samples are not of the
/// same rounds.
pub fn speed<'a>(pairs: impl IntoIterator<Item = (&'a Record, &'a Record)>, noise: &AaNoise) -> Option<Estimate> {
    let cells: Option<Vec<_>> = pairs.into_iter().map(|(own, other)| own.speed_against(other)).collect();
    let cells = cells?;
    let epochs = cells.first()?.len();
    if cells.iter().any(|cell| cell.len() != epochs) {
        return None;
    }
    Some(Rerun::of(&epoch_values(&cells)?, noise.of_mean(cells.len()))?.ratio())
}
