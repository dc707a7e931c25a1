//! Ratios between records, with their intervals. Pure functions: whoever reads records later gets the same.

use crate::measure::{Interval, NoiseFloor, replication};
use crate::report::Record;

/// Seed of the bootstrap: intervals belong to the samples and not to a run's seed.
const SEED: u64 = 1;

/// The A/A ratios of records: how the twin's times relate to those of the structure that it is the twin of, cell by cell.
pub fn twins(records: &[Record]) -> NoiseFloor {
    NoiseFloor::new(&records.iter().filter_map(Record::speed_against_twin).collect::<Vec<_>>(), SEED)
}

/// The geometric mean of how many times faster the first of each pair is than the second, with the
/// [interval](mod@crate::measure::replication) that holds the figure of another run; `floor` is the logarithm of the A/A floor. Nothing where one
/// of them has no time, or their samples are not of the same rounds.
pub fn speed<'a>(pairs: impl IntoIterator<Item = (&'a Record, &'a Record)>, floor: f64) -> Option<Interval> {
    let cells: Option<Vec<_>> = pairs.into_iter().map(|(own, other)| own.speed_against(other)).collect();
    let cells = cells?;
    let epochs = cells.first()?.len();
    if cells.iter().any(|cell| cell.len() != epochs) {
        return None;
    }
    replication(&cells, floor, SEED)
}
