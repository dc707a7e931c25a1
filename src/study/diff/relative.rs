//! Times relative to the times of obvhs in the same rounds: comparable between days and machines.

use super::has_reference_role;
use crate::measure::{AaNoise, Variance};
use crate::report::words::distinct;
use crate::study::measurement::Measurement;

/// The variance that the A/A noise of a run adds to a mean over `cells` cells of times relative to `references`
/// references: the noise of each cell is independent.
pub(super) fn weighted(noise: &AaNoise, references: usize, cells: usize) -> Variance {
    let mut weights = vec![-1.0 / references.max(1) as f64; references];
    weights.push(1.0);
    noise.weighted(&weights).times(1.0 / libm::sqrt(cells.max(1) as f64))
}

/// Labels of the structures that normalise both runs.
pub(super) fn references(pairs: &[(&Measurement, &Measurement)]) -> Vec<String> {
    let is_timed =
        |(old, new): &&(&Measurement, &Measurement)| !old.samples_ns.is_empty() && !new.samples_ns.is_empty();
    let timed = pairs.iter().filter(is_timed).map(|(old, _)| old);
    distinct(timed.filter(|old| has_reference_role(old)).map(|old| &old.label))
}

/// ln(time of `own` / geometric mean of the references' times), by epoch and round; ln(time) without a reference. A
/// reference counts only if it has a time in the same cell of `others`, so both runs are divided by the same
/// structures. `None` without a time.
pub(super) fn relative(
    own: &Measurement,
    all: &[Measurement],
    other: &Measurement,
    others: &[Measurement],
    references: &[String],
) -> Option<Vec<Vec<f64>>> {
    if own.samples_ns.is_empty() || other.samples_ns.is_empty() {
        return None;
    }
    let rivals: Vec<&Measurement> = references
        .iter()
        .filter(|label| beside(label, other, others).is_some())
        .filter_map(|label| beside(label, own, all))
        .collect();
    if rivals.is_empty() {
        return references.is_empty().then(|| absolute(own));
    }
    let mut sum: Option<Vec<Vec<f64>>> = None;
    for rival in &rivals {
        // Speed of the reference relative to `own`.
        let logs = rival.speed_against(own)?;
        sum = Some(match sum {
            None => logs,
            Some(sum) => sum.iter().zip(&logs).map(|(a, b)| a.iter().zip(b).map(|(a, b)| a + b).collect()).collect(),
        });
    }
    let share = 1.0 / rivals.len() as f64;
    sum.map(|epochs| epochs.iter().map(|epoch| epoch.iter().map(|log| log * share).collect()).collect())
}

fn beside<'a>(label: &str, own: &Measurement, all: &'a [Measurement]) -> Option<&'a Measurement> {
    let same = |r: &&Measurement| r.label == label && r.scene == own.scene && r.workload == own.workload;
    all.iter().find(same).filter(|r| !r.samples_ns.is_empty())
}

fn absolute(own: &Measurement) -> Vec<Vec<f64>> {
    let logs: Vec<f64> = own.samples_ns.iter().map(|ns| libm::log(ns / own.rays as f64)).collect();
    logs.chunks((logs.len() / own.epochs.max(1)).max(1)).map(<[f64]>::to_vec).collect()
}
