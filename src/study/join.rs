//! Joins the separately measured epochs of a scene into one measurement. A pure function of the measurements.
//!
//! Only epoch 0 checks and counts: its results hold for all epochs, and without it the scene is left out. Epochs belong
//! to one measurement if they have the same rays, number of timed rays, number of samples and hits.

use super::StudyError;
use super::dataset::Measured;
use super::epoch::{Epoch, Rays, Structure};
use super::error::ANSWERS;
use crate::registry::RUNNER;
use crate::report::words::listed;

/// Cases for a report, and the reasons why other cases are left out.
#[derive(Debug, Default)]
pub struct JoinedEpochs {
    /// In the order of the input.
    pub measured: Vec<Measured>,
    /// The errors that end scenes: their cases are left out.
    pub failures: Vec<StudyError>,
    /// Scenes without a check, one sentence each: their cases are left out.
    pub unchecked: Vec<String>,
    /// Planned epochs that are missing, one sentence each.
    pub missing: Vec<String>,
}

/// Joins the epochs of each scene. A scene that counts only as a [whole](super::case::Settings::whole) is left out if a
/// structure lacks a time.
pub fn join(mut measured: Vec<Measured>) -> JoinedEpochs {
    let mut joined = JoinedEpochs::default();
    let mut out = vec![];
    for mut places in scenes(&measured) {
        places.sort_by_key(|&place| measured[place].case.epoch);
        let case = measured[places[0]].case.clone();
        let mut own: Vec<Epoch> = places.iter().map(|&place| measured[place].epoch.clone()).collect();
        if case.epoch != 0 {
            let lacks = lacks(&case.scene_title(), &[0]);
            joined.unchecked.push(format!("{lacks}; epoch 0 checks the hits, so the scene is left out."));
            out.extend(places);
            continue;
        }
        let agree = if case.settings.whole { Epoch::check_complete } else { Epoch::check_agreement };
        let found = one(&mut own).and_then(|()| own.iter().try_for_each(agree));
        if let Err(error) = found {
            joined.failures.push(error);
            out.extend(places);
            continue;
        }
        let there: Vec<usize> = own.iter().map(|epoch| epoch.epoch).collect();
        let planned = places.iter().map(|&place| measured[place].case.epochs).max().unwrap_or(0);
        let not_there: Vec<usize> = (0..planned).filter(|number| !there.contains(number)).collect();
        if !not_there.is_empty() {
            joined.missing.push(format!("{}.", lacks(&case.scene_title(), &not_there)));
        }
        for (place, own) in places.into_iter().zip(own) {
            measured[place].epoch = own;
        }
    }
    let kept = measured.into_iter().enumerate().filter(|(place, _)| !out.contains(place));
    joined.measured = kept.map(|(_, measured)| measured).collect();
    joined
}

/// The indices of the cases of each scene.
fn scenes(measured: &[Measured]) -> Vec<Vec<usize>> {
    let mut found: Vec<Vec<usize>> = vec![];
    for (place, own) in measured.iter().enumerate() {
        match found.iter_mut().find(|places| measured[places[0]].case.is_of_scene(&own.case)) {
            Some(places) => places.push(place),
            None => found.push(vec![place]),
        }
    }
    found
}

/// `Dragon: epochs 1 and 2 are not measured`.
fn lacks(title: &str, missing: &[usize]) -> String {
    let numbers: Vec<String> = missing.iter().map(ToString::to_string).collect();
    let (epochs, are) = if missing.len() == 1 { ("epoch", "is") } else { ("epochs", "are") };
    format!("{title}: {epochs} {} {are} not measured", listed(&numbers))
}

/// Turns the epochs of a scene, epoch 0 first, into one measurement.
fn one(epochs: &mut [Epoch]) -> Result<(), StudyError> {
    let (title, structures) = (epochs[0].title(), epochs[0].structures.len());
    for place in 0..structures {
        let label = epochs[0].structures[place].label.clone();
        let apart = |epoch: &Epoch, rays: &str, what: &'static str| StudyError::Apart {
            structure: label.clone(),
            scene: title.clone(),
            rays: rays.into(),
            epoch: epoch.epoch,
            what,
        };
        if let Some(other) = epochs.iter().find(|e| e.structures.get(place).is_none_or(|own| own.label != label)) {
            return Err(apart(other, "", "the structures"));
        }
        // A structure that is refused in one epoch is refused in all.
        let refused = epochs.iter().find_map(|epoch| epoch.structures[place].refused.clone());
        if let Some(reason) = refused {
            refuse(epochs, place, &reason);
            continue;
        }
        for kind in 0..epochs[0].structures[place].rays.len() {
            let first = epochs[0].structures[place].rays[kind].clone();
            let alike = |epoch: &&Epoch| {
                let own = epoch.structures[place].rays.get(kind);
                own.is_some_and(|own| own.hash == first.hash && own.workload == first.workload && own.all == first.all)
            };
            if let Some(other) = epochs.iter().find(|epoch| !alike(epoch)) {
                return Err(apart(other, &first.workload, "the rays"));
            }
            if first.untimed.is_some() {
                let (untimed, wrong) = (first.untimed, first.wrong);
                for rays in epochs.iter_mut().skip(1).map(|epoch| &mut epoch.structures[place].rays[kind]) {
                    *rays = Rays {
                        ns: vec![],
                        parts: vec![],
                        rays: 0,
                        checksum: 0,
                        untimed: untimed.clone(),
                        wrong,
                        ..rays.clone()
                    };
                }
                continue;
            }
            let of = |epoch: &Epoch| epoch.structures[place].rays[kind].clone();
            let structure = &epochs[0].structures[place];
            let (is_program, may_err) = (structure.name == RUNNER, structure.may_err());
            let other = epochs.iter().find(|epoch| of(epoch).checksum != first.checksum);
            match (other, may_err) {
                (Some(_), true) => {
                    refuse(epochs, place, CHANGED);
                    break;
                }
                (Some(other), false) => return Err(apart(other, &first.workload, ANSWERS)),
                (None, _) => {}
            }
            if let Some(other) = epochs.iter().find(|epoch| of(epoch).ns.len() != first.ns.len()) {
                return Err(apart(other, &first.workload, "the number of samples"));
            }
            let Some(other) = epochs.iter().find(|epoch| of(epoch).rays != first.rays) else { continue };
            if !is_program {
                return Err(apart(other, &first.workload, "the number of timed rays"));
            }
            if !reduce(epochs, place, kind) {
                refuse(epochs, place, UNSTEADY);
                break;
            }
        }
    }
    keep_common_parts(epochs);
    Ok(())
}

/// Reason for a structure of another crate whose hits change after a rebuild. Packets do so: other rays travel
/// together.
const CHANGED: &str = "after a rebuild it returns other hits than before: its times are not comparable";

/// Reason for a runner whose epochs have no rays in common.
const UNSTEADY: &str = "its speed differs by more than a factor of sixteen between epochs (by its own clock), so no \
                        rays are timed in all of them";

/// Refuses a structure in all epochs; for wrong hits if one of them has wrong hits.
fn refuse(epochs: &mut [Epoch], place: usize, reason: &str) {
    let wrong = epochs.iter().any(|epoch| epoch.structures[place].wrong);
    for structure in epochs.iter_mut().map(|epoch| &mut epoch.structures[place]) {
        *structure = Structure { refused: Some(reason.into()), wrong, rays: vec![], ..structure.clone() };
    }
}

/// Reduces the samples of a runner to the largest subset that all epochs have. Returns whether there is one.
fn reduce(epochs: &mut [Epoch], place: usize, kind: usize) -> bool {
    let timed = |rays: &Rays, count: usize| rays.rays == count || rays.parts.iter().any(|part| part.rays == count);
    let of = |epoch: &Epoch| epoch.structures[place].rays[kind].clone();
    let first = of(&epochs[0]);
    let counts = std::iter::once(first.rays).chain(first.parts.iter().map(|part| part.rays));
    let Some(common) = counts.into_iter().find(|&count| epochs.iter().all(|epoch| timed(&of(epoch), count))) else {
        return false;
    };
    for rays in epochs.iter_mut().map(|epoch| &mut epoch.structures[place].rays[kind]) {
        if let Some(part) = rays.parts.iter().find(|part| part.rays == common) {
            (rays.ns, rays.rays) = (part.ns.clone(), common);
        }
        rays.parts.retain(|part| part.rays < common);
    }
    true
}

/// Reduces each structure to the subsets that all epochs have.
fn keep_common_parts(epochs: &mut [Epoch]) {
    for place in 0..epochs[0].structures.len() {
        for kind in 0..epochs[0].structures[place].rays.len() {
            let parts = |epoch: &Epoch| -> Vec<usize> {
                epoch.structures[place].rays[kind].parts.iter().map(|part| part.rays).collect()
            };
            let all: Vec<Vec<usize>> = epochs.iter().map(parts).collect();
            for rays in epochs.iter_mut().map(|epoch| &mut epoch.structures[place].rays[kind]) {
                rays.parts.retain(|part| all.iter().all(|own| own.contains(&part.rays)));
            }
        }
    }
}

#[cfg(test)]
mod tests;
