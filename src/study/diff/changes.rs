//! Changes of time, each with the outcome of its interval.

use super::relative::{references, relative, weighted};
use super::{Change, Finding};
use crate::measure::{AaNoise, Estimate, Rerun, cut_to_shared_epochs, epoch_values};
use crate::report::words::each_once;
use crate::study::measurement::{Measurement, trace_noise};

/// The changes of the structures, each looked at `looks` times, and of their cells.
pub(super) fn all(
    old: &[Measurement],
    new: &[Measurement],
    pairs: &[(&Measurement, &Measurement)],
    threshold: Option<f64>,
    looks: usize,
) -> (Vec<Change>, Vec<Change>) {
    let references = references(pairs);
    let noises = [old, new].map(trace_noise);
    let (mut structures, mut cells): (Vec<Change>, Vec<Change>) = (vec![], vec![]);
    let labels = each_once(pairs.iter().map(|(_, new)| new.label.as_str()));
    let labels: Vec<&str> = labels.into_iter().filter(|label| !references.iter().any(|one| one == label)).collect();
    // The intervals of structures are corrected for their number and for the looks; cells decide nothing.
    let looks = looks * labels.len();
    for label in labels {
        let mut all: (Vec<_>, Vec<_>) = (vec![], vec![]);
        let mut missing = false;
        let own = || pairs.iter().filter(|(_, new)| new.label == label);
        for (before, after) in own() {
            let times = || {
                Some((relative(before, old, after, new, &references)?, relative(after, new, before, old, &references)?))
            };
            let times = times();
            let time = times.as_ref().and_then(|(old, new)| {
                change(std::slice::from_ref(old), std::slice::from_ref(new), &noises, references.len())
            });
            cells.push(Change {
                structure: label.into(),
                scene: Some(before.scene_title()),
                workload: Some(before.workload.clone()),
                cells: usize::from(time.is_some()),
                checked_rays: after.checked_rays,
                time,
                finding: finding(time, threshold),
            });
            // Without an old time, of itself or of a reference, it is not missing.
            missing |= !before.samples_ns.is_empty() && after.samples_ns.is_empty();
            if let Some((old, new)) = times {
                all.0.push(old);
                all.1.push(new);
            }
        }
        let n = all.0.len();
        cut_to_shared_epochs(&mut all.0);
        cut_to_shared_epochs(&mut all.1);
        let time = if missing { None } else { change(&all.0, &all.1, &noises, references.len()) };
        let time = time.map(|time| time.ratio_among(looks));
        // Without any time, as for wrong hits, there is nothing to change.
        if n == 0 && !missing {
            continue;
        }
        structures.push(Change {
            structure: label.into(),
            scene: None,
            workload: None,
            cells: n,
            checked_rays: own().map(|(_, new)| new.checked_rays).sum(),
            time,
            finding: finding(time, threshold),
        });
    }
    (structures, cells)
}

/// The geometric mean over cells of new / old; both are relative to the mean of `references` references.
fn change(old: &[Vec<Vec<f64>>], new: &[Vec<Vec<f64>>], noises: &[AaNoise; 2], references: usize) -> Option<Estimate> {
    let noises = [&noises[0], &noises[1]].map(|noise| weighted(noise, references, old.len()));
    Some(Rerun::change(&epoch_values(old)?, &epoch_values(new)?, noises)?.ratio())
}

/// With a threshold: a regression is at or above it and significantly slower; a pass is significantly below it.
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
