//! How fast structures were from commit to commit.
//!
//! `compare --save-baseline` adds a line to a file, `history.jsonl` beside the baselines: of each structure what it takes to hold this run
//! against any other one. Times of different days are compared as `diff` compares them, relative to obvhs in the same rounds; runs that
//! [`unlike`](fn@super::diff::unlike) refuses on one machine are different series.

mod file;
mod merged;
mod series;
#[cfg(test)]
mod tests;

use serde::{Deserialize, Serialize};

use super::diff::{RelativeTime, relative_times};
use crate::measure::Provenance;
use crate::report::Record;

pub use file::{FILE, HistoryError, add, read};
pub use merged::merged;
pub use series::{Series, Step, series};

/// A run that was kept.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Entry {
    pub schema: u32,
    pub baseline: String,
    pub provenance: Provenance,
    /// Structures of obvhs whose mean time is the unit.
    pub references: Vec<String>,
    pub structures: Vec<RelativeTime>,
}

impl Entry {
    /// Version of the form.
    pub const SCHEMA: u32 = 1;

    /// Of a run; nothing without a time of obvhs, which runs of different days are compared by.
    pub fn new(baseline: &str, records: &[Record]) -> Option<Self> {
        let provenance = records.first()?.provenance.clone();
        let (references, structures) = relative_times(records);
        let entry = Self { schema: Self::SCHEMA, baseline: baseline.into(), provenance, references, structures };
        (!entry.references.is_empty() && !entry.structures.is_empty()).then_some(entry)
    }

    /// What runs of one series have in common: the name, and what `unlike` asks of a machine and a build.
    fn of_series(&self) -> [&dyn std::fmt::Debug; 11] {
        let Self { baseline, references, provenance: p, .. } = self;
        [
            baseline,
            references,
            &p.cpu,
            &p.simd,
            &p.target,
            &p.target_features,
            &p.threads,
            &p.process_per_epoch,
            &p.clock,
            &p.profile,
            &p.obvhs,
        ]
    }

    fn is_of_series_of(&self, other: &Self) -> bool {
        format!("{:?}", self.of_series()) == format!("{:?}", other.of_series())
    }

    /// Whether this is the run of the same sources: one of changed sources never is.
    fn replaces(&self, other: &Self) -> bool {
        let commit = &self.provenance.commit;
        let is_known = !commit.ends_with("+changes") && commit != "unknown";
        is_known && *commit == other.provenance.commit && self.is_of_series_of(other)
    }
}
