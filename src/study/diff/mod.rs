//! Compares two runs of the same study: changes in speed and in hits. All functions except [`read`](fn@read) are pure.
//!
//! Times of two runs at different moments on a shared machine are not comparable. So `diff` compares ratios to
//! references, by default the structures of obvhs. Their code is the same in both runs, and they are measured in the
//! same rounds as all other structures. `diff` can even compare runs of two machines, with a warning that the machine
//! may cause a change. A gate requires one machine.
//!
//! A cell is one workload of one scene. The change of a structure is the geometric mean, over its cells, of new time /
//! old time, both relative to the references. The [interval](fn@crate::measure::Rerun::change) of the change decides
//! the finding. It is corrected for the number of structures, and for how often a gate looks at the growing runs.
//!
#![doc = include_str!("GATE.md")]

mod changes;
mod keys;
mod read;
mod table;
#[cfg(test)]
mod tests;
mod unlike;

use serde::Serialize;

use super::measurement::{Measurement, measurements};
use super::{Dataset, Status, measurement};
use crate::measure::{Estimate, Provenance};
use crate::registry::is_named;
use crate::report::words::each_once;
use crate::request::known_defect;
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

/// The role of a reference structure.
const REFERENCE: &str = "reference";

impl Side {
    /// `reference` names the reference structure. `None`: all obvhs structures with the obvhs triangle test.
    pub fn new(dataset: &Dataset, reference: Option<&str>) -> Self {
        Self::of(dataset.provenance.clone(), measurements(dataset), reference)
    }

    fn of(provenance: Provenance, mut all: Vec<Measurement>, reference: Option<&str>) -> Self {
        for own in &mut all {
            if reference.map_or_else(|| measurement::is_native_obvhs(own), |name| is_named(&own.label, name)) {
                own.role = REFERENCE.into();
            }
        }
        Self { provenance, all }
    }

    pub fn has_reference(&self) -> bool {
        self.all.iter().any(has_reference_role)
    }
}

fn has_reference_role(own: &Measurement) -> bool {
    own.role == REFERENCE
}

/// The differences between two runs.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Comparison {
    /// Labels of the reference structures that normalise both runs. If there are none, the times are not normalised.
    pub references: Vec<String>,
    /// The smallest slowdown that counts as a regression, in percent; `None` if `diff` only prints changes.
    pub threshold_percent: Option<f64>,
    /// How often a gate may compare the growing runs, at most. The intervals are corrected for this number.
    pub looks: usize,
    /// One change per structure that is not a reference. A structure is included if it has comparable times in a cell,
    /// or if the new run lacks a time that the old run has.
    pub structures: Vec<Change>,
    /// One change per cell of each structure that is not a reference.
    pub cells: Vec<Change>,
    /// Cells in which the rate of wrong hits has more than doubled, or in which hits differ between the runs.
    pub wrong: Vec<Wrong>,
    /// Keys and triangle tests that differ between the runs, such as `leaf of mybvh 4, now 8`.
    pub differences: Vec<String>,
    pub settings: Vec<String>,
    /// The processor and SIMD level of each run; `None` if they are equal.
    pub machines: Option<[String; 2]>,
    /// Cells that only the old run has, such as `mybvh on the primary rays of Cube`.
    pub only_old: Vec<String>,
    /// Cells that only the new run has.
    pub only_new: Vec<String>,
}

/// The change in time of a structure: in one cell, or the mean over its cells.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Change {
    /// The label in the new run.
    pub structure: String,
    /// `None` for the mean over all cells.
    pub scene: Option<String>,
    pub workload: Option<String>,
    /// The number of cells that have a time in both runs.
    pub cells: usize,
    /// Rays of the new run whose hits were checked.
    pub checked_rays: usize,
    /// New time / old time, both relative to the references; `None` if one of the runs has no time.
    pub time: Option<Estimate>,
    pub finding: Finding,
}

/// The classification of a change by its estimate and interval. The threshold is a ratio: 1.1 for 10 %.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Finding {
    /// The interval lies below 1.
    Faster,
    /// The interval contains 1. With a threshold, the interval also lies below the threshold.
    NoDifference,
    /// The interval lies above 1. With a threshold, the interval also lies below the threshold.
    Slower,
    /// Only with a threshold: the estimate is at least the threshold, and the interval lies above 1.
    Regression,
    /// Only with a threshold: the interval reaches the threshold, but there is no regression. More epochs or a quieter
    /// machine would decide.
    Inconclusive,
    /// One of the runs has no time, or only one epoch and therefore no interval.
    Unknown,
}

/// A cell with wrong or changed hits.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Wrong {
    /// The label in the new run.
    pub structure: String,
    /// Structure, workload and scene.
    pub case: String,
    pub what: String,
}

impl Comparison {
    /// Compares two runs that [`unlike`](fn@unlike) accepts. With a threshold, a slowdown of at least
    /// `threshold_percent` is a regression. `looks` is the maximum number of comparisons while the runs grow. Because
    /// each comparison may raise a false alarm, `looks` widens the intervals.
    pub fn new(old: &Side, new: &Side, threshold_percent: Option<f64>, looks: usize) -> Self {
        let machines = other_machine(&old.provenance, &new.provenance);
        let (old, new) = (&old.all[..], &new.all[..]);
        let pairs = pairs(old, new);
        let only = |own: &[Measurement], other: &[Measurement]| -> Vec<String> {
            own.iter().filter(|one| counterpart(one, own, other).is_none()).map(cell_title).collect()
        };
        let threshold = threshold_percent.map(|percent| libm::log1p(percent / 100.0));
        let (structures, cells) = changes::all(old, new, &pairs, threshold, looks);
        Self {
            references: changes::references(&pairs),
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
        }
    }

    fn has(&self, finding: Finding) -> bool {
        self.structures.iter().any(|change| change.finding == finding)
    }

    /// The exit status. Wrong hits take precedence over cells missing in the new run, missing cells over regressions,
    /// regressions over inconclusive results.
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

/// Pairs of an old and a new measurement of the same structure in the same cell.
fn pairs<'a>(old: &'a [Measurement], new: &'a [Measurement]) -> Vec<(&'a Measurement, &'a Measurement)> {
    old.iter().filter_map(|own| Some((own, counterpart(own, old, new)?))).collect()
}

/// The measurement in `others` that corresponds to `own`, a measurement of `run`: the same label in the same cell. If
/// no label matches, because changed keys change the label, the name of the structure must match; each run must then
/// have exactly one unmatched measurement with this name in this cell. Otherwise `None`.
fn counterpart<'a>(own: &Measurement, run: &[Measurement], others: &'a [Measurement]) -> Option<&'a Measurement> {
    fn cell(own: &Measurement) -> (&str, bool, &str, &str) {
        (&own.scene, own.stand_in, &own.workload, &own.role)
    }
    fn labelled<'a>(own: &Measurement, others: &'a [Measurement]) -> Option<&'a Measurement> {
        others.iter().find(|other| other.label == own.label && cell(other) == cell(own))
    }
    labelled(own, others).or_else(|| {
        let is_rival = |other: &&Measurement| other.structure == own.structure && cell(other) == cell(own);
        let mut left = others.iter().filter(is_rival).filter(|other| labelled(other, run).is_none());
        let is_alone = run.iter().filter(is_rival).filter(|one| labelled(one, others).is_none()).count() == 1;
        left.next().filter(|_| is_alone && left.next().is_none())
    })
}

/// Keys and triangle tests that differ, without duplicates.
fn differences(pairs: &[(&Measurement, &Measurement)]) -> Vec<String> {
    let of_pair = |(old, new): &(&Measurement, &Measurement)| {
        let mut found = other_keys(&old.config, &new.config);
        let [before, after] = [old, new].map(|own| own.triangle_test.clone());
        found.extend((before != after).then(|| ("triangle test".into(), before, after)));
        let name = new.structure.clone();
        found.into_iter().map(move |(key, old, now)| format!("{key} of {name} {old}, now {now}"))
    };
    each_once(pairs.iter().flat_map(of_pair))
}

fn other_machine(old: &Provenance, new: &Provenance) -> Option<[String; 2]> {
    let machines = [old, new].map(|own| format!("{} ({})", own.cpu, own.simd));
    (machines[0] != machines[1]).then_some(machines)
}

fn cell_title(record: &Measurement) -> String {
    format!("{} on the {} rays of {}", record.label, record.workload, record.scene_title())
}

fn wrong(old: &Measurement, new: &Measurement) -> Option<Wrong> {
    let rate = |r: &Measurement| r.wrong_hits as f64 / r.checked_rays.max(1) as f64;
    let (errors, checked) = (new.wrong_hits, new.checked_rays);
    // The runs may check different numbers of rays, so compare error rates. Errors count if the old run has none, or if
    // the rate has more than doubled. Errors of a structure with known defects do not count.
    let known = known_defect(&new.structure).is_some();
    let more = errors > 0 && !known && (old.wrong_hits == 0 || rate(new) > 2.0 * rate(old));
    let is_changed = || old.hit_checksum.zip(new.hit_checksum).is_some_and(|(old, new)| old != new);
    let what = match () {
        () if more => {
            let before = format!("{} of {}", old.wrong_hits, old.checked_rays);
            format!("{errors} of {checked} rays have a wrong hit; in the old run {before}")
        }
        // Do not compare hits of different triangle tests. Each run has checked its hits against its triangle test.
        () if old.triangle_test != new.triangle_test => return None,
        () if old.counts.rays == new.counts.rays && old.counts.hits != new.counts.hits => {
            format!("{} of {} rays hit; in the old run {}", new.counts.hits, new.counts.rays, old.counts.hits)
        }
        () if old.rays == new.rays && is_changed() => {
            "some hits have another t or primitive than in the old run".into()
        }
        () => return None,
    };
    Some(Wrong { structure: new.label.clone(), case: cell_title(new), what })
}
