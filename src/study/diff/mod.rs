//! Compares the speed and the hits of two runs of the same study.
//!
//! The load of the machine may differ between runs. So `diff` compares times relative to reference structures. The
//! reference structures must have the same code in both runs. They are measured in the same rounds as all other
//! structures.
//!
//! A cell is one workload of one scene. The change of a structure is the geometric mean of new time / old time over all
//! cells.
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

#[derive(Clone, Debug)]
pub struct Side {
    pub provenance: Provenance,
    pub all: Vec<Measurement>,
}

const REFERENCE: &str = "reference";

impl Side {
    /// `reference` names the reference structure. If `None`, all obvhs structures with the obvhs triangle test are
    /// references.
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

#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Comparison {
    /// Labels of the reference structures. If empty, times are absolute.
    pub references: Vec<String>,
    /// The smallest slowdown that may be a regression. `None` if the comparison is not a gate.
    pub threshold_percent: Option<f64>,
    /// The maximum number of comparisons while epochs are added to the runs.
    pub looks: usize,
    /// Includes a structure if it has comparable times, or if the new run lacks a time of the old run.
    pub structures: Vec<Change>,
    pub cells: Vec<Change>,
    /// Cells in which the rate of wrong hits has more than doubled, or in which hits differ between the runs.
    pub wrong: Vec<Wrong>,
    /// Changed configuration keys and triangle tests, such as `leaf of mybvh 4, now 8`.
    pub differences: Vec<String>,
    pub settings: Vec<String>,
    /// The processor and SIMD level of each run. `None` if the runs have the same processor and SIMD level.
    pub machines: Option<[String; 2]>,
    /// Measurements that only the old run has, such as `mybvh on the primary rays of Cube`.
    pub only_old: Vec<String>,
    pub only_new: Vec<String>,
}

#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Change {
    /// The label in the new run.
    pub structure: String,
    /// `None` for the mean over all cells.
    pub scene: Option<String>,
    pub workload: Option<String>,
    pub cells: usize,
    /// The number of checked rays in the new run.
    pub checked_rays: usize,
    /// New time / old time, relative to the references. `None` if a time is missing.
    pub time: Option<Estimate>,
    pub finding: Finding,
}

/// The class of a change, by the estimate and interval of [`Change::time`]. The threshold is a ratio, for example 1.1
/// for 10 %.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Finding {
    /// The interval lies below 1.
    Faster,
    /// The interval contains 1. With a threshold, the interval also lies below the threshold.
    NoDifference,
    /// The interval lies above 1. With a threshold, the interval also lies below the threshold.
    Slower,
    /// The estimate is at least the threshold, and the interval lies above 1.
    Regression,
    /// Not a regression, but the upper end of the interval is at least the threshold.
    Inconclusive,
    /// A run has no time or only one epoch.
    Unknown,
}

#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Wrong {
    pub structure: String,
    /// Names the structure, the workload and the scene.
    pub case: String,
    pub what: String,
}

impl Comparison {
    /// Compares two runs for which [`unlike`](fn@unlike) returns `Ok`. The intervals of `structures` are corrected for
    /// the number of structures and `looks`. The intervals of `cells` are not corrected.
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

fn pairs<'a>(old: &'a [Measurement], new: &'a [Measurement]) -> Vec<(&'a Measurement, &'a Measurement)> {
    old.iter().filter_map(|own| Some((own, counterpart(own, old, new)?))).collect()
}

/// Finds the measurement of the same structure, scene and workload in the other run. Changed keys change the label. So
/// if no label matches, the names of the structures are compared. A match by name must be unique in both runs.
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
    // The runs may check different numbers of rays, so the rates are compared.
    let known = known_defect(&new.structure).is_some();
    let more = errors > 0 && !known && (old.wrong_hits == 0 || rate(new) > 2.0 * rate(old));
    let is_changed = || old.hit_checksum.zip(new.hit_checksum).is_some_and(|(old, new)| old != new);
    let what = match () {
        () if more => {
            let before = format!("{} of {}", old.wrong_hits, old.checked_rays);
            format!("{errors} of {checked} rays have a wrong hit; in the old run {before}")
        }
        // Different triangle tests may return different hits.
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
