//! The measurements that a study plans.

use std::collections::BTreeMap;
use std::ffi::OsStr;
use std::path::PathBuf;
use std::time::Duration;

use super::case::{Case, Settings};
use crate::escaped::quoted;
use crate::request::{SceneRequest, StructureRequest, ViewArgs, WorkloadRequest, named_notes};
use crate::scene::Scene;

/// The cases of a run, in the order in which they are measured.
#[derive(Clone, Debug, Default)]
pub struct Plan {
    pub cases: Vec<Case>,
    /// Notes below the tables.
    pub notes: Vec<String>,
    /// The notes to print before the measurement.
    pub warnings: Vec<String>,
    /// Files that the study reads: no output may replace them.
    pub inputs: Vec<PathBuf>,
    /// Time limit of a scene: no further epoch starts that would exceed it.
    pub limit: Option<Duration>,
    /// Whether the journal is kept in the folder `runs` by default.
    pub keep_journal: bool,
}

/// One scene of a plan.
pub struct PlannedScene {
    pub request: SceneRequest,
    pub labels: BTreeMap<String, String>,
    pub structures: Vec<StructureRequest>,
    pub workloads: WorkloadRequest,
    pub settings: Settings,
    pub epochs: usize,
}

impl PlannedScene {
    /// A scene with its own camera, without labels.
    pub fn new(
        (word, scene): &(impl AsRef<OsStr>, Scene),
        structures: &[StructureRequest],
        workloads: &WorkloadRequest,
        settings: &Settings,
        epochs: usize,
    ) -> Self {
        Self {
            request: SceneRequest::new(word.as_ref(), &ViewArgs::default(), scene),
            labels: BTreeMap::new(),
            structures: structures.to_vec(),
            workloads: workloads.clone(),
            settings: settings.clone(),
            epochs,
        }
    }

    /// The same scene with a label.
    pub fn labelled(mut self, name: &str, value: impl Into<String>) -> Self {
        self.labels.insert(name.into(), value.into());
        self
    }
}

impl Plan {
    /// All epochs of `scenes`, epoch 0 of all scenes first, with a journal that is kept.
    pub fn by_epoch(study: &str, scenes: &[PlannedScene]) -> Self {
        let command: Vec<String> = std::env::args_os().map(quoted).collect();
        let command = command.join(" ");
        let case = |planned: &PlannedScene, epoch: usize| Case {
            study: study.into(),
            scene: planned.request.clone(),
            labels: planned.labels.clone(),
            structures: planned.structures.clone(),
            workloads: planned.workloads.clone(),
            settings: planned.settings.clone(),
            epoch,
            epochs: planned.epochs,
            command: command.clone(),
        };
        let most = scenes.iter().map(|planned| planned.epochs).max().unwrap_or(0);
        let of_epoch = |epoch| scenes.iter().filter(move |planned| epoch < planned.epochs).map(move |own| (own, epoch));
        let cases = (0..most).flat_map(of_epoch).map(|(planned, epoch)| case(planned, epoch)).collect();
        Self { cases, keep_journal: true, ..Self::default() }
    }

    /// The same plan, scene by scene: the tables of a scene are ready before the next scene begins.
    pub fn by_scene(mut self) -> Self {
        let mut order: Vec<String> = vec![];
        let mut number = |case: &Case| {
            let key = Case { epoch: 0, ..case.clone() }.key();
            order.iter().position(|known| *known == key).unwrap_or_else(|| {
                order.push(key);
                order.len() - 1
            })
        };
        self.cases.sort_by_cached_key(|case| number(case));
        self
    }

    /// The same plan with the notes and warnings of its scenes.
    pub fn noting<'a>(mut self, scenes: impl IntoIterator<Item = &'a Scene> + Clone) -> Self {
        self.notes.extend(named_notes(scenes.clone(), |scene| &scene.notes));
        self.warnings.extend(named_notes(scenes, |scene| &scene.warnings));
        self
    }
}

#[cfg(test)]
mod tests {
    use super::super::case::tests::example;
    use super::*;

    #[test]
    fn epochs_of_all_scenes_come_before_the_next_unless_the_plan_is_by_scene() {
        let planned = |scene: &str, epochs| {
            let case = example(scene, 0, &["sah-kd"]);
            PlannedScene {
                request: case.scene,
                labels: BTreeMap::new(),
                structures: case.structures,
                workloads: case.workloads,
                settings: case.settings,
                epochs,
            }
        };
        let plan = Plan::by_epoch("compare", &[planned("B", 3), planned("A", 2)]);
        let keys = |plan: &Plan| plan.cases.iter().map(|case| format!("{}{}", case.scene.name, case.epoch)).collect();
        let found: Vec<String> = keys(&plan);
        assert_eq!(found, ["B0", "A0", "B1", "A1", "B2"]);
        let found: Vec<String> = keys(&plan.by_scene());
        assert_eq!(found, ["B0", "B1", "B2", "A0", "A1"]);
    }
}
