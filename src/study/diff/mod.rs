//! What changed between two runs of the same comparison: speed, answers, and whether a ratio of one is found again in
//! the other. Pure functions of datasets.
//!
//! Two runs of different moments on a shared machine cannot be compared by their times. They are compared by their
//! ratios to references: the structures of obvhs, whose code is the same in both runs and which are measured in the
//! same rounds as all others. So `diff` compares commits on two machines as well, and says that the machine may be the
//! reason of a change; a gate wants one machine.
//!
//! The change of a structure is the geometric mean over its cells of new / old, decided by its
//! [interval](fn@crate::measure::Rerun::change), which allows for all structures and for every look at them; cells alone
//! are shown and decide nothing, for there are many of them.
//!
//! # In continuous integration
#![doc = include_str!("GATE.md")]

mod changes;
mod keys;
mod read;
mod relative;
mod table;
#[cfg(test)]
mod tests;
mod unlike;

use serde::Serialize;

use super::measurement::{Measurement, measurements, trace_noise};
use super::{Dataset, Status, measurement};
use crate::measure::{AaNoise, Estimate, Provenance, Rerun, epoch_values};
use crate::registry::is_named;
use crate::report::words::each_once;
use crate::request::{REPORT_TREE, known_defect};
use keys::other_keys;

pub use read::read;
pub use table::{cautions, sentences, tables};
pub use unlike::{Unlike, settings, unlike, unlike_plan};

/// One of the two runs.
#[derive(Clone, Debug)]
pub struct Side {
    pub provenance: Provenance,
    pub all: Vec<Measurement>,
}

/// The role of what the other structures are judged relative to.
const REFERENCE: &str = "reference";

impl Side {
    /// A run, judged relative to the structure of the label `reference`; without one to those of obvhs.
    pub fn new(dataset: &Dataset, reference: Option<&str>) -> Self {
        Self::of(dataset.provenance.clone(), measurements(dataset), reference)
    }

    fn of(provenance: Provenance, mut all: Vec<Measurement>, reference: Option<&str>) -> Self {
        for own in &mut all {
            if reference.map_or_else(|| measurement::is_reference(own), |name| is_named(&own.label, name)) {
                own.role = REFERENCE.into();
            }
        }
        Self { provenance, all }
    }

    /// Whether the run has what the others are judged relative to.
    pub fn has_reference(&self) -> bool {
        self.all.iter().any(is_reference)
    }
}

/// Whether the others are judged relative to it.
fn is_reference(own: &Measurement) -> bool {
    own.role == REFERENCE
}

/// Two runs side by side.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Comparison {
    /// Structures that both were normalised by; times are compared as they are where there are none.
    pub references: Vec<String>,
    /// The regression that is looked for, per cent; nothing where any difference is.
    pub threshold_percent: Option<f64>,
    /// How often a verdict about all structures may be asked for: so many times the structures are judged together.
    pub looks: usize,
    /// One for each structure that is no reference.
    pub structures: Vec<Change>,
    /// One for each structure that is no reference, scene and workload.
    pub cells: Vec<Change>,
    /// Answers that were right, or others, in the old run.
    pub wrong: Vec<Wrong>,
    /// Keys and triangle tests of structures that differ, as `leaf of mybvh 4, now 8`.
    pub differences: Vec<String>,
    /// Settings that differ.
    pub settings: Vec<String>,
    /// Processor and lanes of the old and of the new run, where they are not the same.
    pub machines: Option<[String; 2]>,
    /// Cases that only one of the runs has.
    pub only_old: Vec<String>,
    pub only_new: Vec<String>,
    pub reproduced: Reproduced,
}

/// How much longer a structure takes.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Change {
    /// As the new run names it.
    pub structure: String,
    /// Nothing for the mean over all cells.
    pub scene: Option<String>,
    pub workload: Option<String>,
    /// Cells in it that have a time in both runs.
    pub cells: usize,
    /// Rays of the new run whose answers were checked.
    pub checked_rays: usize,
    /// New time / old time; nothing where one of the runs has none.
    pub time: Option<Estimate>,
    pub finding: Finding,
}

/// What an estimate and its interval say.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Finding {
    /// The interval lies below 1.
    Faster,
    /// The interval holds 1 and, with a threshold, lies below it.
    NoDifference,
    /// The interval lies above 1 and, with a threshold, below it.
    Slower,
    /// The estimate has reached the threshold, and the interval lies above 1.
    Regression,
    /// Neither a regression nor an interval below the threshold: more samples or a quieter machine would tell.
    Inconclusive,
    /// There is no time in one of the runs, or no interval, for one of them has a single epoch.
    Unknown,
}

/// Answers that changed for the worse.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Wrong {
    /// As the new run names it.
    pub structure: String,
    /// Structure, scene and rays.
    pub case: String,
    /// What is wrong.
    pub what: String,
}

/// How many ratios of one run are found again in the other.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Reproduced {
    pub ratios: usize,
    /// Ratios of the old run within the new run's intervals.
    pub old_in_new: usize,
    /// The other way round.
    pub new_in_old: usize,
    /// Ratios whose change cannot be told from none, by the spread of both runs.
    pub unchanged: usize,
}

impl Comparison {
    /// Compares two runs that are not [unlike]. With a threshold in per cent, regressions of at least as much are
    /// looked for. `looks` is how often the new run is compared at most while it goes on: every look is a chance to be
    /// wrong.
    pub fn new(old: &Side, new: &Side, threshold_percent: Option<f64>, looks: usize) -> Self {
        let machines = other_machine(&old.provenance, &new.provenance);
        let (old, new) = (&old.all[..], &new.all[..]);
        let pairs = pairs(old, new);
        let only = |own: &[Measurement], other: &[Measurement]| -> Vec<String> {
            own.iter().filter(|one| counterpart(one, own, other).is_none()).map(case).collect()
        };
        let threshold = threshold_percent.map(|percent| libm::log1p(percent / 100.0));
        let (structures, cells) = changes::all(old, new, &pairs, threshold, looks);
        Self {
            references: relative::references(&pairs),
            threshold_percent,
            looks,
            structures,
            cells,
            wrong: pairs.iter().filter_map(|(old, new)| wrong(old, new)).collect(),
            differences: differences(&pairs),
            settings: vec![],
            machines,
            only_old: only(old, new),
            only_new: only(new, old),
            reproduced: reproduced(old, new),
        }
    }

    fn has(&self, finding: Finding) -> bool {
        self.structures.iter().any(|change| change.finding == finding)
    }

    /// What it comes to: wrong answers weigh more than missing ones, those more than slow ones.
    pub fn status(&self) -> Status {
        let is_gate = self.threshold_percent.is_some();
        match () {
            () if !self.wrong.is_empty() => Status::Wrong,
            () if is_gate && !self.only_old.is_empty() => Status::Refused,
            () if self.has(Finding::Regression) => Status::Regression,
            () if self.has(Finding::Inconclusive) => Status::Undecided,
            () if is_gate && self.has(Finding::Unknown) => Status::Undecided,
            () => Status::Right,
        }
    }
}

/// What both runs measured, side by side.
fn pairs<'a>(old: &'a [Measurement], new: &'a [Measurement]) -> Vec<(&'a Measurement, &'a Measurement)> {
    old.iter().filter_map(|own| Some((own, counterpart(own, old, new)?))).collect()
}

/// What `others` measured in place of `own`, which is of `run`: on the same scene and workload the structure with the same
/// label. Where there is none, its keys have changed: then the one structure of its name that has no other counterpart.
fn counterpart<'a>(own: &Measurement, run: &[Measurement], others: &'a [Measurement]) -> Option<&'a Measurement> {
    fn labelled<'a>(own: &Measurement, others: &'a [Measurement]) -> Option<&'a Measurement> {
        let cell = |m: &Measurement| (m.scene.clone(), m.stand_in, m.workload.clone(), m.role.clone());
        others.iter().find(|other| other.label == own.label && cell(other) == cell(own))
    }
    labelled(own, others).or_else(|| {
        let is_rival = |other: &&Measurement| {
            (&other.scene, other.stand_in, &other.workload, &other.role, &other.structure)
                == (&own.scene, own.stand_in, &own.workload, &own.role, &own.structure)
        };
        let mut left = others.iter().filter(is_rival).filter(|other| labelled(other, run).is_none());
        let is_alone = run.iter().filter(is_rival).filter(|one| labelled(one, others).is_none()).count() == 1;
        left.next().filter(|_| is_alone && left.next().is_none())
    })
}

/// Keys and triangle tests that differ, each once.
fn differences(pairs: &[(&Measurement, &Measurement)]) -> Vec<String> {
    let of_pair = |(old, new): &(&Measurement, &Measurement)| {
        let mut found = other_keys(&old.config, &new.config);
        if old.triangle_test != new.triangle_test {
            found.push(("triangle test".into(), old.triangle_test.clone(), new.triangle_test.clone()));
        }
        let name = new.structure.clone();
        found.into_iter().map(move |(key, old, new)| format!("{key} of {name} {old}, now {new}"))
    };
    each_once(pairs.iter().flat_map(of_pair))
}

fn other_machine(old: &Provenance, new: &Provenance) -> Option<[String; 2]> {
    let machine = |own: &Provenance| format!("{} ({})", own.cpu, own.simd);
    let machines = [old, new].map(machine);
    (machines[0] != machines[1]).then_some(machines)
}

fn case(record: &Measurement) -> String {
    format!("{} on the {} rays of {}", record.label, record.workload, record.scene_title())
}

fn wrong(old: &Measurement, new: &Measurement) -> Option<Wrong> {
    let rate = |r: &Measurement| r.structure_errors as f64 / r.checked_rays.max(1) as f64;
    let (errors, checked) = (new.structure_errors, new.checked_rays);
    // How many rays are checked depends on time: what an error was before is no new one if its rate is the same, and
    // what a baseline is documented to get wrong may be met at any time.
    let known = known_defect(&new.structure).is_some();
    let more = errors > 0 && !known && (old.structure_errors == 0 || rate(new) > 2.0 * rate(old));
    let what = if more {
        format!("{errors} of {checked} rays have a wrong hit, {} of {} had", old.structure_errors, old.checked_rays)
    } else if old.triangle_test != new.triangle_test {
        // Another test has other hits: each is held against its own by the checks of its run.
        return None;
    } else if old.counted_rays == new.counted_rays && old.hits != new.hits {
        format!("{} of {} rays hit, {} did before", new.hits, new.counted_rays, old.hits)
    } else if old.rays == new.rays && old.answers.is_some() && new.answers.is_some() && old.answers != new.answers {
        "hits have another t or primitive".into()
    } else {
        return None;
    };
    Some(Wrong { structure: new.label.clone(), case: case(new), what })
}

/// Holds the ratios of each run against the intervals of the other: of every structure to the report's tree and to the
/// structures of obvhs, cell by cell, as tables print them.
fn reproduced(old: &[Measurement], new: &[Measurement]) -> Reproduced {
    let noises = [old, new].map(trace_noise);
    let mut found = Reproduced::default();
    for (own, own_new) in pairs(old, new) {
        let to = |base: &&Measurement| {
            let same = base.scene == own.scene && base.workload == own.workload && base.label != own.label;
            same && (base.label == REPORT_TREE || is_reference(base))
        };
        for base in old.iter().filter(to) {
            let values = |own: &Measurement, base: &Measurement| epoch_values(&[own.speed_against(base)?]);
            let values = || Some([values(own, base)?, values(own_new, counterpart(base, old, new)?)?]);
            let Some([a, b]) = values() else { continue };
            let [noise_a, noise_b] = noises.each_ref().map(AaNoise::of_ratio);
            let ratio = |values: &[f64], epochs: usize, noise| {
                Rerun::in_epochs(values, epochs, noise)
                    .map(|rerun| rerun.ratio())
                    .filter(|ratio| ratio.interval.is_some())
            };
            let change = Rerun::change(&a, &b, [noise_a, noise_b]).map(|change| change.ratio());
            let (a, b) = (ratio(&a, b.len(), noise_a), ratio(&b, a.len(), noise_b));
            let (Some(a), Some(b), Some(change)) = (a, b, change) else { continue };
            found.ratios += 1;
            found.old_in_new += usize::from(b.holds(a.estimate));
            found.new_in_old += usize::from(a.holds(b.estimate));
            found.unchanged += usize::from(change.holds(1.0));
        }
    }
    found
}
