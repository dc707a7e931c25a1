//! Times relative to those of obvhs in the same rounds, which runs of different days and machines have in common.

use serde::{Deserialize, Serialize};

use crate::measure::{AaNoise, Estimate, Rerun, Variance, checksum, cut_to_shared_epochs, epoch_values};
use crate::report::Record;
use crate::report::words::{distinct, each_once};
use crate::study::compare::twins;
use crate::study::reference_structures::is_reference;

/// The time of a structure in one run, relative to the references.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct RelativeTime {
    pub label: String,
    /// Tells apart what the rays and scenes of its cells are.
    pub rays: String,
    /// ln(time / geometric mean of the references' times), mean over the cells, of each epoch.
    pub epochs: Vec<f64>,
    /// What the A/A noise adds to the variance of their mean, and its degrees of freedom, where it is known.
    pub noise: Option<[f64; 2]>,
}

impl RelativeTime {
    pub fn noise(&self) -> Variance {
        self.noise.map_or(Variance::NONE, |[square, freedom]| Variance { square, freedom })
    }

    /// How many times as fast as the references it is; nothing without an epoch.
    pub fn speed(&self) -> Option<Estimate> {
        let speeds: Vec<f64> = self.epochs.iter().map(|log| -log).collect();
        Some(Rerun::of(&speeds, self.noise())?.ratio())
    }
}

/// The structures of obvhs that have a time, and what of a run can be held against another one: all structures over the cells in which they have
/// a time, and the epochs that all of these have.
pub fn relative_times(records: &[Record]) -> (Vec<String>, Vec<RelativeTime>) {
    let own: Vec<(&Record, &Record)> = records.iter().map(|record| (record, record)).collect();
    let references = references(&own);
    let noise = twins(records);
    let labels = records.iter().map(|record| record.label.as_str());
    let labels = each_once(labels.filter(|label| !references.iter().any(|reference| reference == label)));
    let of = |label: &&str| {
        let timed = records.iter().filter(|record| record.label == *label);
        let cells = timed.filter_map(|own| Some((own, relative(own, records, own, records, &references)?)));
        let (own, mut cells): (Vec<&Record>, Vec<Vec<Vec<f64>>>) = cells.unzip();
        cut_to_shared_epochs(&mut cells);
        let noise = weighted(&noise, references.len(), cells.len());
        let bytes = |record: &&Record| {
            let Record { scene_hash, workload_hash, .. } = *record;
            format!("{scene_hash} {workload_hash} ").into_bytes()
        };
        Some(RelativeTime {
            label: (*label).into(),
            rays: format!("{:016x}", checksum(own.iter().flat_map(bytes).map(u64::from))),
            epochs: epoch_values(&cells)?,
            noise: noise.freedom.is_finite().then_some([noise.square, noise.freedom]),
        })
    };
    let times = if references.is_empty() { vec![] } else { labels.iter().filter_map(of).collect() };
    (references, times)
}

/// What the A/A noise of a run adds to the variance of a mean over `cells` cells of times relative to so many references: the luck of each
/// cell is its own.
pub(super) fn weighted(noise: &AaNoise, references: usize, cells: usize) -> Variance {
    let mut weights = vec![-1.0 / references.max(1) as f64; references];
    weights.push(1.0);
    noise.weighted(&weights).times(1.0 / libm::sqrt(cells.max(1) as f64))
}

/// Labels of the structures that both runs are normalised by.
pub(super) fn references(pairs: &[(&Record, &Record)]) -> Vec<String> {
    let is_timed = |(old, new): &&(&Record, &Record)| !old.samples_ns.is_empty() && !new.samples_ns.is_empty();
    let timed = pairs.iter().filter(is_timed).map(|(old, _)| old);
    distinct(timed.filter(|old| is_reference(old)).map(|old| &old.label))
}

/// ln(time of `own` / geometric mean of the references' times) of each round in each epoch; ln of the time itself where
/// there is no reference. Only references that have a time in the same cell of `others`, too, count, so that both runs
/// are divided by the same. Nothing where there is no time.
pub(super) fn relative(
    own: &Record,
    records: &[Record],
    other: &Record,
    others: &[Record],
    references: &[String],
) -> Option<Vec<Vec<f64>>> {
    if own.samples_ns.is_empty() || other.samples_ns.is_empty() {
        return None;
    }
    let rivals: Vec<&Record> = references
        .iter()
        .filter(|label| beside(label, other, others).is_some())
        .filter_map(|label| beside(label, own, records))
        .collect();
    if rivals.is_empty() {
        return references.is_empty().then(|| absolute(own));
    }
    let mut sum: Option<Vec<Vec<f64>>> = None;
    for rival in &rivals {
        // How many times faster the reference is.
        let logs = rival.speed_against(own)?;
        sum = Some(match sum {
            None => logs,
            Some(sum) => sum.iter().zip(&logs).map(|(a, b)| a.iter().zip(b).map(|(a, b)| a + b).collect()).collect(),
        });
    }
    let share = 1.0 / rivals.len() as f64;
    sum.map(|epochs| epochs.iter().map(|epoch| epoch.iter().map(|log| log * share).collect()).collect())
}

fn beside<'a>(label: &str, own: &Record, records: &'a [Record]) -> Option<&'a Record> {
    let same = |r: &&Record| r.label == label && r.scene == own.scene && r.workload == own.workload;
    records.iter().find(same).filter(|r| !r.samples_ns.is_empty())
}

fn absolute(own: &Record) -> Vec<Vec<f64>> {
    let logs: Vec<f64> = own.samples_ns.iter().map(|ns| libm::log(ns / own.rays as f64)).collect();
    logs.chunks((logs.len() / own.epochs.max(1)).max(1)).map(<[f64]>::to_vec).collect()
}
