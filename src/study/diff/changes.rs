//! Changes of time, each with what its interval says.

use super::relative::{references, relative, weighted};
use super::{Change, Finding};
use crate::measure::{AaNoise, Estimate, Rerun, cut_to_shared_epochs, epoch_values};
use crate::report::words::each_once;
use crate::study::measurement::{Measurement, trace_noise};

/// Of the structures, of which each is looked at `looks` times, and of their cells.
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
    let labels = each_once(pairs.iter().map(|(old, _)| old.label.as_str()));
    let labels: Vec<&str> = labels.into_iter().filter(|label| !references.iter().any(|one| one == label)).collect();
    // All structures are judged together, as often as is looked; their cells decide nothing.
    let looks = looks * labels.len();
    for label in labels {
        let mut all: (Vec<_>, Vec<_>) = (vec![], vec![]);
        let mut missing = false;
        for (before, after) in pairs.iter().filter(|(old, _)| old.label == label) {
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
                time,
                finding: finding(time, threshold),
            });
            // What never had a time, itself or of what it is divided by, is not missing.
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
        // What never had a time, as what answers wrongly, has nothing that could change.
        if n == 0 && !missing {
            continue;
        }
        structures.push(Change {
            structure: label.into(),
            scene: None,
            workload: None,
            cells: n,
            time,
            finding: finding(time, threshold),
        });
    }
    (structures, cells)
}

/// The geometric mean over cells of new / old, of ratios to the mean of so many references.
fn change(old: &[Vec<Vec<f64>>], new: &[Vec<Vec<f64>>], noises: &[AaNoise; 2], references: usize) -> Option<Estimate> {
    let noises = [&noises[0], &noises[1]].map(|noise| weighted(noise, references, old.len()));
    Some(Rerun::change(&epoch_values(old)?, &epoch_values(new)?, noises)?.ratio())
}

pub(super) fn finding(time: Option<Estimate>, threshold: Option<f64>) -> Finding {
    let Some(time) = time.filter(|time| time.interval.is_some()) else { return Finding::Unknown };
    let limit = threshold.map_or(f64::INFINITY, libm::exp);
    match () {
        () if time.is_above(limit) => Finding::Regression,
        () if time.high() > Some(limit) => Finding::Undecided,
        () if time.is_below(1.0) => Finding::Faster,
        () if time.is_above(1.0) => Finding::Slower,
        () => Finding::NoDifference,
    }
}
