//! The plan of a study contains the cases to measure.

use std::collections::BTreeMap;
use std::ffi::OsStr;
use std::path::PathBuf;
use std::time::Duration;

use super::{Case, Settings};
use crate::escaped::quoted;
use crate::report::words::each_once;
use crate::request::{SceneRequest, StructureRequest, ViewArgs, WorkloadRequest, named_notes};
use crate::scene::Scene;

#[derive(Clone, Debug, Default)]
pub struct Plan {
    /// The run measures the cases from first to last.
    pub cases: Vec<Case>,
    /// Notes below the tables.
    pub notes: Vec<String>,
    /// Printed before the measurement.
    pub warnings: Vec<String>,
    /// Files that the study reads. No output may replace these files.
    pub inputs: Vec<PathBuf>,
    /// Time limit for all epochs of a scene. The run skips epochs that would probably exceed the limit.
    pub limit: Option<Duration>,
    pub keep_journal: bool,
}

pub struct PlannedScene {
    /// Epoch 0 of the scene. [`Plan::by_epoch`] sets the study and adds all later epochs.
    pub case: Case,
}

impl PlannedScene {
    pub fn new(
        (word, scene): &(impl AsRef<OsStr>, Scene),
        structures: &[StructureRequest],
        workloads: &WorkloadRequest,
        settings: &Settings,
        epochs: usize,
    ) -> Self {
        let case = Case {
            study: String::new(),
            scene: SceneRequest::new(word.as_ref(), &ViewArgs::default(), scene),
            labels: BTreeMap::new(),
            structures: structures.to_vec(),
            workloads: workloads.clone(),
            settings: settings.clone(),
            epoch: 0,
            epochs,
            command: std::env::args_os().map(quoted).collect::<Vec<_>>().join(" "),
        };
        Self { case }
    }

    pub fn labelled(mut self, name: &str, value: impl Into<String>) -> Self {
        self.case.labels.insert(name.into(), value.into());
        self
    }
}

impl Plan {
    /// Creates one case per epoch of each scene, sorted by epoch.
    pub fn by_epoch(study: &str, scenes: &[PlannedScene]) -> Self {
        let most = scenes.iter().map(|planned| planned.case.epochs).max().unwrap_or(0);
        let of_epoch = |epoch| {
            let planned = scenes.iter().map(|planned| &planned.case).filter(move |case| epoch < case.epochs);
            planned.map(move |case| Case { study: study.into(), epoch, ..case.clone() })
        };
        Self { cases: (0..most).flat_map(of_epoch).collect(), keep_journal: true, ..Self::default() }
    }

    /// Sorts the cases by scene. The tables of a scene are then ready before the next scene begins.
    pub fn by_scene(mut self) -> Self {
        let scene = |case: &Case| Case { epoch: 0, ..case.clone() }.key();
        let order = each_once(self.cases.iter().map(scene));
        self.cases.sort_by_cached_key(|case| order.iter().position(|known| *known == scene(case)));
        self
    }

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
        let planned = |scene: &str, epochs| PlannedScene { case: Case { epochs, ..example(scene, 0, &["sah-kd"]) } };
        let plan = Plan::by_epoch("compare", &[planned("B", 3), planned("A", 2)]);
        let keys = |plan: &Plan| plan.cases.iter().map(|case| format!("{}{}", case.scene.name, case.epoch)).collect();
        let found: Vec<String> = keys(&plan);
        assert_eq!(found, ["B0", "A0", "B1", "A1", "B2"]);
        let found: Vec<String> = keys(&plan.by_scene());
        assert_eq!(found, ["B0", "B1", "B2", "A0", "A1"]);
    }
}
