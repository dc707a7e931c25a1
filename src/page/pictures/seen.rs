//! What all structures do for the camera rays of one scene.

use super::shown::Shown;
use crate::accel::Observed;
use crate::page::runs::Runs;
use crate::registry::Registry;
use crate::render::{ErrorMap, ExactPicture, Work, coarse_size};
use crate::report::words::{distinct, scene_name};
use crate::study::{BRUTE_FORCE, REPORT_TREE, SAH_TREE, guarded};

/// A picture of a scene, answered by exact arithmetic and by every structure of the runs but brute force, whose work would darken
/// that of all others.
pub struct Seen<'a> {
    pub shown: &'a Shown,
    /// As figures name the scene.
    pub name: String,
    pub exact: ExactPicture,
    pub structures: Vec<SeenStructure>,
}

/// What one structure does for each pixel, row by row.
pub struct SeenStructure {
    pub label: String,
    pub observed: Observed,
    pub work: Vec<Work>,
}

impl<'a> Seen<'a> {
    /// Structures that cannot be built, panic or decline these rays are left out.
    pub fn new(shown: &'a Shown, runs: &Runs, registry: &Registry) -> Self {
        let scene = &shown.scene;
        let exact = ExactPicture::new(scene, coarse_size(scene));
        let labels = distinct(runs.records().iter().filter(|r| r.scene == scene.name).map(|r| &r.label));
        let labels = if labels.is_empty() { [REPORT_TREE, SAH_TREE].map(String::from).into() } else { labels };
        let structure = |label: String| {
            let choice = registry.choose(&label).ok().filter(|choice| choice.entry.name != BRUTE_FORCE)?;
            let can = choice.entry.capabilities;
            if exact.rays.iter().any(|ray| can.declines(ray).is_some()) {
                return None;
            }
            let accel = choice.build(&scene.mesh).ok()?;
            let work = guarded(|| Work::of(accel.as_ref(), &exact.rays))?;
            Some(SeenStructure { label, observed: choice.entry.observed, work })
        };
        let structures = labels.into_iter().filter_map(structure).collect();
        Self { shown, name: scene_name(&scene.name, !scene.stand_ins.is_empty()), exact, structures }
    }

    /// Where the answers of a structure are wrong.
    pub fn errors(&self, structure: &SeenStructure) -> ErrorMap {
        ErrorMap::of(&self.exact, structure.work.iter().map(|work| work.hit))
    }
}
