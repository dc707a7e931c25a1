//! Traces the camera rays of one scene with several structures.

use image::RgbImage;

use super::scenes::LoadedScene;
use crate::accel::Observed;
use crate::page::runs::{COMPARE, Runs};
use crate::registry::Registry;
use crate::render::{ErrorMap, ExactPicture, Work, coarse_size, png};
use crate::report::Picture;
use crate::report::words::{each_once, scene_name};
use crate::request::{BRUTE_FORCE, REPORT_TREE, SAH_TREE};
use crate::study::measure::guarded;

pub struct CameraRays<'a> {
    pub loaded: &'a LoadedScene,
    pub name: String,
    pub exact: ExactPicture,
    pub structures: Vec<StructureWork>,
}

pub struct StructureWork {
    pub label: String,
    pub observed: Observed,
    /// One element per pixel, row by row.
    pub work: Vec<Work>,
}

impl<'a> CameraRays<'a> {
    /// Leaves out each structure that cannot be built, panics or declines a ray. Brute force is left out because its
    /// cost would darken all heat maps on the shared scale.
    pub fn new(loaded: &'a LoadedScene, runs: &Runs, registry: &Registry) -> Self {
        let scene = &loaded.scene;
        let exact = ExactPicture::new(scene, coarse_size(scene));
        let measured = runs.of(COMPARE).map_or(&[][..], |run| &run.dataset.measured);
        let own = measured.iter().filter(|own| own.case.scene.hash == loaded.request.hash);
        let mut labels = each_once(own.flat_map(|own| &own.epoch.structures).map(|structure| structure.label.clone()));
        if labels.is_empty() {
            labels = [REPORT_TREE, SAH_TREE].map(String::from).into();
        }
        let structure = |label: String| {
            let choice = registry.choose(&label).ok().filter(|choice| choice.entry.name != BRUTE_FORCE)?;
            let can = choice.entry.capabilities;
            if exact.rays.iter().any(|ray| can.declines(ray).is_some()) {
                return None;
            }
            let accel = choice.build(&scene.mesh).ok()?;
            let work = guarded(|| Work::of(accel.as_ref(), &exact.rays))?;
            Some(StructureWork { label, observed: choice.entry.observed, work })
        };
        let structures = labels.into_iter().filter_map(structure).collect();
        Self { loaded, name: scene_name(&scene.name, !scene.stand_ins.is_empty()), exact, structures }
    }

    pub fn errors(&self, structure: &StructureWork) -> ErrorMap {
        ErrorMap::of(&self.exact, structure.work.iter().map(|work| work.hit))
    }

    pub fn picture(&self, label: &str, alt: String, note: String, image: &RgbImage) -> Picture {
        Picture { name: label.into(), note, alt, png: png(image), size: self.exact.size }
    }
}
