//! `compare`: every structure builds, is checked, counted and timed on every workload of a scene.

mod cells;
mod epoch;
mod means;
mod prepare;
mod records;
mod reference;
mod table;
#[cfg(test)]
mod tests;
mod trials;

use super::Refused;
use crate::accel::{DynAccel, Query};
use crate::measure::Threads;
use crate::registry::Choice;
use crate::report::Record;
use crate::scene::{Workload, WorkloadKind};

pub use cells::{speed, twins};
pub use epoch::Trial;
pub use means::{mean_table, winner};
pub use reference::Reference;
pub use table::{legend, scene_table};
pub use trials::Trials;

/// What is compared, and for how long.
pub struct Settings {
    /// The structures, in the order of the tables.
    pub structures: Vec<Choice>,
    /// The structure that tells where secondary rays start.
    pub guide: Choice,
    /// The kinds of rays. `Mirror` is left out of scenes without mirrors.
    pub workloads: Vec<WorkloadKind>,
    /// Rays made before, in place of those kinds where there are any.
    pub replayed: Option<Workload>,
    /// Rays of a workload that are timed, at most: whole tiles of its picture, whose size is the scene's.
    pub rays: usize,
    /// Samples of every case, at least 1: as many in each epoch, so a few more where epochs do not divide them, and
    /// fewer where there is not time for them all.
    pub runs: usize,
    /// How often everything is built anew, at least 1.
    pub epochs: usize,
    /// Whether one structure is built and timed twice, for the A/A ratios.
    pub twin: bool,
    /// What a scene may take, builds included, nanoseconds: slow cases are timed on fewer rays to keep within it.
    pub budget_ns: u64,
    /// What the samples of an epoch may take, nanoseconds, whatever the budget; nothing: what builds and checks leave
    /// of it.
    pub epoch_ns: Option<u64>,
    /// Seed of the workloads, of the order of builds and of the order of samples.
    pub seed: u64,
    pub threads: Threads,
}

impl Settings {
    /// Samples that one epoch takes of every case, at most.
    pub fn rounds(&self) -> usize {
        self.runs.div_ceil(self.epochs)
    }
}

/// What came of one scene.
#[derive(Clone, Debug, Default)]
pub struct Compared {
    /// One for each structure and workload, in the order of the settings, structure by structure.
    pub records: Vec<Record>,
    /// The structures without records.
    pub refused: Vec<Refused>,
}

impl Compared {
    /// All scenes of a run, one after the other.
    pub fn joined(scenes: Vec<(&str, Self)>) -> Self {
        let mut all = Self::default();
        for (_, of_scene) in scenes {
            all.records.extend(of_scene.records);
            all.refused.extend(of_scene.refused);
        }
        all
    }
}

/// What of a workload a structure declines, if anything is: then it has no time.
pub(super) fn declined(accel: &dyn DynAccel, workload: &Workload) -> Option<&'static str> {
    let can = accel.capabilities();
    if workload.query == Query::Any && !can.any_hit {
        return Some("any hit");
    }
    workload.rays.iter().find_map(|ray| can.declines(ray))
}
