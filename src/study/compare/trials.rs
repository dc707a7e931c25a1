//! Several scenes at once.

use super::{Compared, Settings, Trial};
use crate::measure::Clock;
use crate::scene::Scene;
use crate::study::{Stage, StudyError};

/// A comparison on several scenes while it runs. All of them take part in every epoch, so that what happens to the machine for a minute
/// happens to all, every scene meets what happens over the whole run, and epochs can be added where those taken so far do not decide.
pub struct Trials<'a> {
    trials: Vec<Trial<'a>>,
}

impl<'a> Trials<'a> {
    /// Prepares every scene; `progress` is told its name and what is done.
    ///
    /// # Errors
    /// If the structure that tells where secondary rays start cannot be built.
    pub fn new(
        scenes: &'a [Scene],
        settings: &'a Settings,
        clock: &'a dyn Clock,
        progress: &mut dyn FnMut(&str, Stage),
    ) -> Result<Self, StudyError> {
        let trials =
            scenes.iter().map(|scene| Trial::new(scene, settings, clock, &mut |stage| progress(&scene.name, stage)));
        Ok(Self { trials: trials.collect::<Result<_, _>>()? })
    }

    /// One epoch of every scene. One in which it fails is left out from then on.
    ///
    /// # Errors
    /// If a structure answers the same rays differently; the other scenes have their epoch.
    pub fn epoch(&mut self, progress: &mut dyn FnMut(&str, Stage)) -> Result<(), StudyError> {
        let mut failure = None;
        self.trials.retain_mut(|trial| {
            let name = trial.scene_name();
            match trial.epoch(&mut |stage| progress(name, stage)) {
                Ok(()) => true,
                Err(error) => {
                    failure.get_or_insert(error);
                    false
                }
            }
        });
        failure.map_or(Ok(()), Err)
    }

    /// What is known so far of each scene, with its name.
    ///
    /// # Panics
    /// If there was no epoch.
    pub fn results(&self) -> Vec<(&'a str, Compared)> {
        self.trials.iter().map(|trial| (trial.scene_name(), trial.results())).collect()
    }
}
