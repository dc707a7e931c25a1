//! Runs that can be held against each other, and what changed between them.

use super::Entry;
use crate::measure::{Estimate, Rerun};
use crate::report::words::each_once;
use crate::study::diff::RelativeTime;
use crate::study::grouped::grouped;

/// Runs of one name on one machine, the oldest first.
#[derive(Clone, Debug, PartialEq)]
pub struct Series {
    pub runs: Vec<Entry>,
    /// Changes that are real: of all structures and pairs of neighbouring runs those whose interval, corrected for looking so often, does
    /// not hold 1.
    pub changes: Vec<Step>,
}

/// The same structure on the same rays in the run before.
fn before<'a>(run: &'a Entry, new: &RelativeTime) -> Option<&'a RelativeTime> {
    run.structures.iter().find(|old| old.label == new.label && old.rays == new.rays)
}

/// A structure that became faster or slower.
#[derive(Clone, Debug, PartialEq)]
pub struct Step {
    pub structure: String,
    /// The number of the later run.
    pub run: usize,
    /// Its time over that of the run before.
    pub time: Estimate,
}

/// The series of a history, in the order in which they begin.
pub fn series(entries: &[Entry]) -> Vec<Series> {
    let runs = grouped(entries.iter().cloned(), Entry::is_of_series_of);
    runs.into_iter().map(|runs| Series { changes: changes(&runs), runs }).collect()
}

fn changes(runs: &[Entry]) -> Vec<Step> {
    let mut found = vec![];
    for (number, pair) in runs.windows(2).enumerate() {
        for new in &pair[1].structures {
            let change = before(&pair[0], new)
                .and_then(|old| Rerun::change(&old.epochs, &new.epochs, [old.noise(), new.noise()]));
            found.extend(change.map(|change| Step {
                structure: new.label.clone(),
                run: number + 1,
                time: change.ratio(),
            }));
        }
    }
    let looks = found.len();
    found.retain(|step| step.time.interval.is_some() && !step.time.ratio_among(looks).holds(1.0));
    found
}

impl Series {
    /// Labels of the structures, in the order in which they first appear.
    pub fn structures(&self) -> Vec<&str> {
        each_once(self.runs.iter().flat_map(|run| &run.structures).map(|one| one.label.as_str()))
    }

    /// Whether anything of a run, but for the first, can be held against the one before.
    pub fn is_compared(&self, run: usize) -> bool {
        self.runs[run].structures.iter().any(|new| before(&self.runs[run - 1], new).is_some())
    }

    /// How many times as fast as the references a structure was in a run.
    pub fn speed(&self, run: usize, label: &str) -> Option<Estimate> {
        self.runs[run].structures.iter().find(|one| one.label == label).and_then(RelativeTime::speed)
    }
}
