//! Studies: each asks a question, plans cases and reports on the measurements.
//!
//! A [`Study`] is a value: the functions `plan` and `report`, and their options. A study does not measure. `engine`
//! measures the planned cases that the journal lacks, one [`Case`] per process, and passes the [`Dataset`] to `report`.

pub mod accuracy;
pub mod attribution;
pub mod case;
pub mod claims;
pub mod compare;
pub mod dataset;
pub mod diff;
mod engine;
pub mod epoch;
mod epoch_medians;
mod error;
mod join;
pub mod journal;
mod kendall;
pub mod measure;
pub mod measurement;
mod plan;
pub mod process;
pub mod replicate;
pub mod scaling;
mod screen;
mod status;
#[cfg(test)]
mod tests;
mod verdict;

use std::ffi::{OsStr, OsString};

use clap::{ArgMatches, Command};

use crate::registry::Registry;
use crate::report::Report;

pub use case::{Case, Check, Settings};
pub use dataset::{Dataset, Measured, SceneEpochs};
pub use engine::{Run, RunOutcome, run};
pub use epoch::Epoch;
pub use error::StudyError;
pub use join::{JoinedEpochs, join};
pub use plan::{Plan, PlannedScene};
pub use screen::{Screen, Stage};
pub use status::Status;
pub use verdict::Verdict;

/// A question, its plan and its report.
pub struct Study {
    /// The name of the subcommand and of the journal folder.
    pub name: &'static str,
    /// The help text and the title in reports: one line.
    pub question: &'static str,
    /// The arguments with which `study all` runs the study.
    pub presets: Presets,
    /// The options of the study. The only positional arguments are scenes.
    pub options: fn() -> Command,
    /// Plans the cases without measuring them; an error if the options name something that cannot be measured.
    pub plan: fn(&ArgMatches, &Registry) -> anyhow::Result<Plan>,
    /// A pure function of the measurements and the options; `sahara report` passes the default options.
    pub report: fn(&Dataset, &ArgMatches) -> Report,
}

/// The arguments with which `study all` runs a study: scenes, then options. `study all SCENE..` replaces the scenes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Presets {
    pub full: &'static str,
    /// The arguments of `study all --quick`: a run takes a few minutes.
    pub quick: &'static str,
}

impl Study {
    /// Parses the arguments `words`.
    pub fn matches<W: AsRef<OsStr>>(&self, words: &[W]) -> Result<ArgMatches, clap::Error> {
        (self.options)().no_binary_name(true).try_get_matches_from(words.iter().map(OsString::from))
    }

    /// The default options. Panics if an argument is required.
    pub fn defaults(&self) -> ArgMatches {
        self.matches::<OsString>(&[]).unwrap_or_else(|error| panic!("study {}: {error}", self.name))
    }

    /// Whether the study accepts scenes.
    pub fn names_scenes(&self) -> bool {
        (self.options)().get_positionals().next().is_some()
    }

    /// The arguments in `preset`, one of the [presets](Self::presets). If `scenes` is not empty, it replaces the scenes
    /// in `preset`. A study that accepts no scenes ignores `scenes`.
    pub fn preset(&self, preset: &str, scenes: &[OsString]) -> Vec<OsString> {
        let scenes = if self.names_scenes() { scenes } else { &[] };
        let options = preset.split_whitespace().skip_while(|word| !scenes.is_empty() && !word.starts_with('-'));
        scenes.iter().cloned().chain(options.map(OsString::from)).collect()
    }

    /// The command that runs the study with its journal in `runs`; `sahara report` reads this folder.
    pub fn command_line(&self) -> String {
        format!("sahara study {} --dir runs", self.name)
    }
}

/// Studies, in the order of the page.
pub struct Studies {
    list: Vec<Study>,
}

impl Studies {
    pub fn empty() -> Self {
        Self { list: vec![] }
    }

    /// The studies of this crate. To add a study, add a line.
    pub fn builtin() -> Self {
        Self::empty()
            .with(attribution::STUDY)
            .with(compare::STUDY)
            .with(scaling::STUDY)
            .with(accuracy::STUDY)
            .with(replicate::STUDY)
    }

    /// Adds a study. Panics if its name is empty, is taken, is `all` or `plan`, or contains other characters than
    /// lower-case letters, digits and hyphens.
    pub fn with(mut self, study: Study) -> Self {
        let plain = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '-';
        let name = study.name;
        assert!(!name.is_empty() && !["all", "plan"].contains(&name) && name.chars().all(plain), "the name {name:?}");
        assert!(self.find(name).is_none(), "there is already a study {name:?}");
        self.list.push(study);
        self
    }

    pub fn iter(&self) -> impl Iterator<Item = &Study> {
        self.list.iter()
    }

    pub fn find(&self, name: &str) -> Option<&Study> {
        self.iter().find(|study| study.name == name)
    }
}
