//! Epochs of a scene, measured each by itself, as one measurement: a pure function of what was measured.
//!
//! Epoch 0 alone is checked and counted: what it found holds for all of them, and without it the scene is left out. What
//! epochs have in common says that they are of one measurement: the rays, how many of them are timed and how often, and
//! the answers to them.

use super::StudyError;
use super::dataset::Measured;
use super::epoch::{Epoch, Rays, Structure};
use super::error::ANSWERS;
use crate::registry::RUNNER;
use crate::report::words::listed;

/// Cases that a report can be made of, and why others are left out.
#[derive(Debug, Default)]
pub struct JoinedEpochs {
    /// In the order in which they were given.
    pub measured: Vec<Measured>,
    /// What ends a scene: its cases are left out.
    pub failures: Vec<StudyError>,
    /// Scenes that are not checked, a sentence each: their cases are left out.
    pub unchecked: Vec<String>,
    /// Epochs that were planned and are not there, a sentence each.
    pub missing: Vec<String>,
}

/// Joins the epochs of each scene. A scene that counts [whole](super::case::Settings::whole) is left out where a
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

/// The places of the cases of each scene.
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

/// Makes the epochs of a scene, the first of which is epoch 0, one measurement.
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
        // What is refused in one of them is refused in all.
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

/// Said of a structure of others that answers otherwise once it is built again, as packets do in which other rays
/// travel together.
const CHANGED: &str = "after a rebuild it returns other hits than before: its times are not comparable";

/// Said of a program whose epochs have no rays in common.
const UNSTEADY: &str =
    "one epoch is more than sixteen times as slow as another by its own clock: the epochs share no rays";

/// Refuses a structure in all epochs, for wrong answers if that is so in one of them.
fn refuse(epochs: &mut [Epoch], place: usize, reason: &str) {
    let wrong = epochs.iter().any(|epoch| epoch.structures[place].wrong);
    for structure in epochs.iter_mut().map(|epoch| &mut epoch.structures[place]) {
        *structure = Structure { refused: Some(reason.into()), wrong, rays: vec![], ..structure.clone() };
    }
}

/// Leaves of the samples of a program the largest part that all epochs have. Whether there is one.
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

/// Leaves of each structure the parts that all epochs have.
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
