//! Compares the times of two runs and classifies each change.

use std::slice::from_ref;

use super::{Change, Finding, has_reference_role};
use crate::measure::{AaNoise, Estimate, Rerun, Variance, cut_to_shared_epochs, epoch_values};
use crate::report::words::{distinct, each_once};
use crate::study::measurement::{Measurement, trace_noise};

/// Returns the mean changes of the structures, and the changes of the structures in single cells.
pub(super) fn all(
    old: &[Measurement],
    new: &[Measurement],
    pairs: &[(&Measurement, &Measurement)],
    threshold: Option<f64>,
    looks: usize,
) -> (Vec<Change>, Vec<Change>) {
    let references = references(pairs);
    let noises = [old, new].map(trace_noise);
    let change = |old: &[_], new: &[_]| change(old, new, &noises, references.len());
    let (mut structures, mut cells): (Vec<Change>, Vec<Change>) = (vec![], vec![]);
    let mut labels = each_once(pairs.iter().map(|(_, new)| new.label.as_str()));
    labels.retain(|label| !references.iter().any(|one| one == label));
    // Bonferroni correction for `looks` comparisons of each structure.
    let looks = looks * labels.len();
    for label in labels {
        let of = |cell: Option<&Measurement>, cells, checked_rays, time| Change {
            structure: label.into(),
            scene: cell.map(Measurement::scene_title),
            workload: cell.map(|cell| cell.workload.clone()),
            cells,
            checked_rays,
            time,
            finding: finding(time, threshold),
        };
        let (mut old_times, mut new_times, mut checked_rays, mut missing) = (vec![], vec![], 0, false);
        for (before, after) in pairs.iter().filter(|(_, new)| new.label == label) {
            let times =
                relative(before, old, after, new, &references).zip(relative(after, new, before, old, &references));
            let time = times.as_ref().and_then(|(old, new)| change(from_ref(old), from_ref(new)));
            cells.push(of(Some(before), usize::from(time.is_some()), after.checked_rays, time));
            checked_rays += after.checked_rays;
            missing |= !before.samples_ns.is_empty() && after.samples_ns.is_empty();
            let (old, new) = times.unzip();
            old_times.extend(old);
            new_times.extend(new);
        }
        // A structure may have no comparable times, for example because of wrong hits.
        if old_times.is_empty() && !missing {
            continue;
        }
        cut_to_shared_epochs(&mut old_times);
        cut_to_shared_epochs(&mut new_times);
        let time = if missing { None } else { change(&old_times, &new_times) };
        structures.push(of(None, old_times.len(), checked_rays, time.map(|time| time.ratio_among(looks))));
    }
    (structures, cells)
}

/// The geometric mean of new time / old time over all cells. `old` and `new` contain logarithms of times, by cell,
/// epoch and round.
fn change(old: &[Vec<Vec<f64>>], new: &[Vec<Vec<f64>>], noises: &[AaNoise; 2], references: usize) -> Option<Estimate> {
    let noises = [&noises[0], &noises[1]].map(|noise| weighted(noise, references, old.len()));
    Some(Rerun::change(&epoch_values(old)?, &epoch_values(new)?, noises)?.ratio())
}

/// `threshold` is the logarithm of the smallest ratio that may be a regression.
pub(super) fn finding(time: Option<Estimate>, threshold: Option<f64>) -> Finding {
    let Some(time) = time.filter(|time| time.interval.is_some()) else { return Finding::Unknown };
    let limit = threshold.map_or(f64::INFINITY, libm::exp);
    match () {
        () if time.estimate >= limit && time.is_above(1.0) => Finding::Regression,
        () if threshold.is_some() && !time.is_below(limit) => Finding::Inconclusive,
        () if time.is_below(1.0) => Finding::Faster,
        () if time.is_above(1.0) => Finding::Slower,
        () => Finding::NoDifference,
    }
}

/// The variance that A/A noise adds to a mean log time over `cells` cells. Each time is relative to the geometric mean
/// of `references` reference times. The noise of different cells is independent.
fn weighted(noise: &AaNoise, references: usize, cells: usize) -> Variance {
    let mut weights = vec![-1.0 / references.max(1) as f64; references];
    weights.push(1.0);
    noise.weighted(&weights).times(1.0 / libm::sqrt(cells.max(1) as f64))
}

pub(super) fn references(pairs: &[(&Measurement, &Measurement)]) -> Vec<String> {
    let is_timed =
        |(old, new): &&(&Measurement, &Measurement)| !old.samples_ns.is_empty() && !new.samples_ns.is_empty();
    let timed = pairs.iter().filter(is_timed).map(|(old, _)| old);
    distinct(timed.filter(|old| has_reference_role(old)).map(|old| &old.label))
}

/// ln(time of `own` / geometric mean of the reference times), by epoch and round. `other` is the counterpart of `own`
/// in the other run. Only references with times in both runs, on the scene and workload of `own`, are used. If
/// `references` is empty, the result is ln(ns per ray).
fn relative(
    own: &Measurement,
    all: &[Measurement],
    other: &Measurement,
    others: &[Measurement],
    references: &[String],
) -> Option<Vec<Vec<f64>>> {
    if own.samples_ns.is_empty() || other.samples_ns.is_empty() {
        return None;
    }
    let is_shared = |label: &&String| beside(label, other, others).is_some();
    let rivals: Vec<_> = references.iter().filter(is_shared).filter_map(|label| beside(label, own, all)).collect();
    if rivals.is_empty() {
        return references.is_empty().then(|| absolute(own));
    }
    let logs = rivals.iter().map(|rival| rival.speed_against(own)).collect::<Option<Vec<_>>>()?;
    let mut sum = logs.into_iter().reduce(|sum, logs| {
        sum.iter().zip(&logs).map(|(a, b)| a.iter().zip(b).map(|(a, b)| a + b).collect()).collect()
    })?;
    let share = 1.0 / rivals.len() as f64;
    sum.iter_mut().flatten().for_each(|log| *log *= share);
    Some(sum)
}

fn beside<'a>(label: &str, own: &Measurement, all: &'a [Measurement]) -> Option<&'a Measurement> {
    let same = |r: &&Measurement| r.label == label && r.scene == own.scene && r.workload == own.workload;
    all.iter().find(same).filter(|r| !r.samples_ns.is_empty())
}

fn absolute(own: &Measurement) -> Vec<Vec<f64>> {
    let logs: Vec<f64> = own.samples_ns.iter().map(|ns| libm::log(ns / own.rays as f64)).collect();
    logs.chunks((logs.len() / own.epochs.max(1)).max(1)).map(<[f64]>::to_vec).collect()
}
