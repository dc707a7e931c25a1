//! Makes the separately measured epochs of each scene comparable.
//!
//! Only epoch 0 checks hits. So a scene without epoch 0 is left out.

use super::epoch::Rays;
use super::error::HITS;
use super::{Epoch, Measured, StudyError};
use crate::registry::RUNNER;
use crate::report::words::listed;

#[derive(Debug, Default)]
pub struct JoinedEpochs {
    /// The joined epochs, in the order of the input.
    pub measured: Vec<Measured>,
    /// One error per scene whose epochs cannot be joined.
    pub failures: Vec<StudyError>,
    /// One sentence per scene without epoch 0.
    pub unchecked: Vec<String>,
    /// One sentence per scene that lacks planned epochs.
    pub missing: Vec<String>,
}

/// With [`whole`](super::case::Settings::whole), every structure must have a time on every workload.
pub fn join(measured: Vec<Measured>) -> JoinedEpochs {
    let mut scenes: Vec<Vec<(usize, Measured)>> = vec![];
    for own in measured.into_iter().enumerate() {
        match scenes.iter_mut().find(|scene| scene[0].1.case.is_of_scene(&own.1.case)) {
            Some(scene) => scene.push(own),
            None => scenes.push(vec![own]),
        }
    }
    let mut joined = JoinedEpochs::default();
    let mut kept = vec![];
    for mut scene in scenes {
        scene.sort_by_key(|(_, own)| own.case.epoch);
        let first = &scene[0].1.case;
        let (title, is_whole) = (first.scene_title(), first.settings.whole);
        if first.epoch != 0 {
            let lacks = lacks(&title, &[0]);
            joined.unchecked.push(format!("{lacks}; epoch 0 checks the hits, so the scene is left out."));
            continue;
        }
        let mut epochs: Vec<&mut Epoch> = scene.iter_mut().map(|(_, own)| &mut own.epoch).collect();
        let agree = if is_whole { Epoch::check_complete } else { Epoch::check_agreement };
        if let Err(error) = make_consistent(&mut epochs).and_then(|()| epochs.iter().try_for_each(|epoch| agree(epoch)))
        {
            joined.failures.push(error);
            continue;
        }
        let planned = scene.iter().map(|(_, own)| own.case.epochs).max().unwrap_or(0);
        let is_missing = |number: &usize| scene.iter().all(|(_, own)| own.epoch.epoch != *number);
        let missing: Vec<usize> = (0..planned).filter(is_missing).collect();
        if !missing.is_empty() {
            joined.missing.push(format!("{}.", lacks(&title, &missing)));
        }
        kept.extend(scene);
    }
    kept.sort_by_key(|(place, _)| *place);
    joined.measured = kept.into_iter().map(|(_, own)| own).collect();
    joined
}

/// A clause such as `Dragon: epochs 1 and 2 are not measured`.
fn lacks(title: &str, missing: &[usize]) -> String {
    let numbers: Vec<String> = missing.iter().map(ToString::to_string).collect();
    let (epochs, are) = if missing.len() == 1 { ("epoch", "is") } else { ("epochs", "are") };
    format!("{title}: {epochs} {} {are} not measured", listed(&numbers))
}

/// Makes the epochs of one scene consistent. `epochs[0]` must be epoch 0.
fn make_consistent(epochs: &mut [&mut Epoch]) -> Result<(), StudyError> {
    let title = epochs[0].title();
    for place in 0..epochs[0].structures.len() {
        let structure = epochs[0].structures[place].clone();
        let apart = |epoch: usize, rays: &str, what: &'static str| {
            let (structure, scene) = (structure.label.clone(), title.clone());
            Err(StudyError::EpochsDiffer { structure, scene, rays: rays.into(), epoch, what })
        };
        let is_other = |epoch: &&&mut Epoch| epoch.structures.get(place).is_none_or(|own| own.label != structure.label);
        if let Some(other) = epochs.iter().find(is_other) {
            return apart(other.epoch, "", "the structures");
        }
        let refused = epochs.iter().find_map(|epoch| epoch.structures[place].refused.clone());
        if let Some(reason) = refused {
            refuse(epochs, place, &reason);
            continue;
        }
        for (kind, first) in structure.rays.iter().enumerate() {
            let differing = |same: fn(&Rays, &Rays) -> bool| {
                let own = |epoch: &Epoch| epoch.structures[place].rays.get(kind).is_some_and(|own| same(own, first));
                epochs.iter().find(|epoch| !own(epoch)).map(|epoch| epoch.epoch)
            };
            let is_alike = |a: &Rays, b: &Rays| (&a.hash, &a.workload, a.all) == (&b.hash, &b.workload, b.all);
            if let Some(other) = differing(is_alike) {
                return apart(other, &first.workload, "the rays");
            }
            if let Some(reason) = &first.untimed {
                for rays in epochs.iter_mut().skip(1).map(|epoch| &mut epoch.structures[place].rays[kind]) {
                    rays.drop_times(reason.clone());
                    rays.wrong = first.wrong;
                }
                continue;
            }
            if let Some(other) = differing(|a, b| a.checksum == b.checksum) {
                if !structure.may_err() {
                    return apart(other, &first.workload, HITS);
                }
                refuse(epochs, place, CHANGED);
                break;
            }
            if let Some(other) = differing(|a, b| a.ns.len() == b.ns.len()) {
                return apart(other, &first.workload, "the number of samples");
            }
            if let Some(other) = differing(|a, b| a.rays == b.rays).filter(|_| structure.name != RUNNER) {
                return apart(other, &first.workload, "the number of timed rays");
            }
            // A runner chooses the number of timed rays by its clock. `rays.ns` gets the times for the largest number
            // of rays that every epoch timed.
            let common = common_sizes(epochs, place, kind);
            let Some(&largest) = common.first() else {
                refuse(epochs, place, UNSTEADY);
                break;
            };
            for rays in epochs.iter_mut().map(|epoch| &mut epoch.structures[place].rays[kind]) {
                if let Some(part) = rays.parts.iter().find(|part| part.rays == largest) {
                    (rays.ns, rays.rays) = (part.ns.clone(), largest);
                }
                rays.parts.retain(|part| part.rays < largest && common.contains(&part.rays));
            }
        }
    }
    Ok(())
}

const CHANGED: &str = "after a rebuild it returns other hits than before: its times are not comparable";

const UNSTEADY: &str = "its speed differs by more than a factor of sixteen between epochs (by its own clock), so no \
                        rays are timed in all of them";

fn refuse(epochs: &mut [&mut Epoch], place: usize, reason: &str) {
    let wrong = epochs.iter().any(|epoch| epoch.structures[place].wrong);
    for structure in epochs.iter_mut().map(|epoch| &mut epoch.structures[place]) {
        (structure.refused, structure.wrong) = (Some(reason.into()), wrong);
        structure.rays.clear();
    }
}

/// Returns each number of timed rays that occurs in every epoch, in descending order.
fn common_sizes(epochs: &[&mut Epoch], place: usize, kind: usize) -> Vec<usize> {
    let sizes = |epoch: &&mut Epoch| -> Vec<usize> {
        let rays = &epoch.structures[place].rays[kind];
        std::iter::once(rays.rays).chain(rays.parts.iter().map(|part| part.rays)).collect()
    };
    let all: Vec<Vec<usize>> = epochs.iter().map(sizes).collect();
    all[0].iter().copied().filter(|size| all.iter().all(|own| own.contains(size))).collect()
}

#[cfg(test)]
mod tests;
