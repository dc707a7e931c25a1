//! Epochs of scenes as the cases of a study.

use super::{Epoch, Settings, key, measure};
use crate::report::words::scene_name;
use crate::scene::Scene;
use crate::study::plan::{named_notes, settings_map};
use crate::study::{Plan, Planned, StudyError};

impl Settings {
    /// A plan of so many epochs of `scenes`, whose cases are the epochs themselves.
    pub fn plan(self, scenes: Vec<Scene>, epochs: u16) -> Plan<Epoch> {
        self.plan_of(scenes, epochs, |_, _, epoch| Ok(epoch))
    }

    /// Likewise. `wrap` makes a case of the epoch of a scene, by the number of the scene.
    pub fn plan_of<C: 'static>(
        self,
        scenes: Vec<Scene>,
        epochs: u16,
        wrap: impl Fn(usize, &Scene, Epoch) -> Result<C, StudyError> + 'static,
    ) -> Plan<C> {
        plan(vec![self], |_| 0, scenes, epochs, wrap)
    }
}

/// As many triangles take the builds of an epoch a quarter of what all else takes, about.
const TRIANGLES: u64 = 12_000;

/// As [`Settings::plan_of`] where scenes have settings of their own: `which` of them.
pub fn plan<C: 'static>(
    settings: Vec<Settings>,
    which: impl Fn(&Scene) -> usize + 'static,
    scenes: Vec<Scene>,
    epochs: u16,
    wrap: impl Fn(usize, &Scene, Epoch) -> Result<C, StudyError> + 'static,
) -> Plan<C> {
    let mut cases = vec![];
    for epoch in 0..usize::from(epochs) {
        for (number, scene) in scenes.iter().enumerate() {
            let name = scene_name(&scene.name, !scene.stand_ins.is_empty());
            let title = format!("epoch {} of {epochs}: {name}", epoch + 1);
            let loads = scene.name.clone();
            // The first epoch checks and counts as well.
            let work = (4 + scene.mesh.len() as u64 / TRIANGLES) * if epoch == 0 { 2 } else { 1 };
            cases.push(Planned { key: key(scene, epoch), title, scene: number, epoch, work, loads });
        }
    }
    let notes = named_notes(&scenes, |scene| &scene.notes);
    let warnings = named_notes(&scenes, |scene| &scene.warnings);
    Plan {
        settings: settings_map(&settings[0].kept()),
        threads: settings[0].threads.clone(),
        limit_ns: None,
        notes,
        warnings,
        inputs: vec![],
        decided: vec![],
        cases,
        measure: Box::new(move |&Planned { scene: number, epoch, .. }, clock, progress| {
            let scene = &scenes[number];
            wrap(number, scene, measure(scene, &settings[which(scene)], epoch, clock, progress)?)
        }),
    }
}
