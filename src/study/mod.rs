//! A study plans the measurements and reports the results.
//!
//! A [`Study`] does not measure. The module `engine` measures the planned cases.

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

pub struct Study {
    /// The name of the subcommand and of the journal folder.
    pub name: &'static str,
    /// One line for the help text and for the title of reports.
    pub question: &'static str,
    pub presets: Presets,
    /// All positional arguments are scenes.
    pub options: fn() -> Command,
    /// Returns an error if the options name something that cannot be measured.
    pub plan: fn(&ArgMatches, &Registry) -> anyhow::Result<Plan>,
    /// A pure function. `sahara report` passes the default options.
    pub report: fn(&Dataset, &ArgMatches) -> Report,
}

/// The arguments that `sahara study all` passes to a study. Scenes must come before options.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Presets {
    pub full: &'static str,
    /// Arguments for `sahara study all --quick`. A run takes a few minutes.
    pub quick: &'static str,
}

impl Study {
    pub fn matches<W: AsRef<OsStr>>(&self, words: &[W]) -> Result<ArgMatches, clap::Error> {
        (self.options)().no_binary_name(true).try_get_matches_from(words.iter().map(OsString::from))
    }

    /// # Panics
    ///
    /// If an argument is required.
    pub fn defaults(&self) -> ArgMatches {
        self.matches::<OsString>(&[]).unwrap_or_else(|error| panic!("study {}: {error}", self.name))
    }

    /// Whether the study accepts scenes.
    pub fn names_scenes(&self) -> bool {
        (self.options)().get_positionals().next().is_some()
    }

    /// A non-empty `scenes` replaces the scenes in `preset`. A study that accepts no scenes ignores `scenes`.
    pub fn preset(&self, preset: &str, scenes: &[OsString]) -> Vec<OsString> {
        let scenes = if self.names_scenes() { scenes } else { &[] };
        let options = preset.split_whitespace().skip_while(|word| !scenes.is_empty() && !word.starts_with('-'));
        scenes.iter().cloned().chain(options.map(OsString::from)).collect()
    }

    pub fn command_line(&self) -> String {
        format!("sahara study {} --dir runs", self.name)
    }
}

pub struct Studies {
    /// In the order of the page.
    list: Vec<Study>,
}

impl Studies {
    pub fn empty() -> Self {
        Self { list: vec![] }
    }

    pub fn builtin() -> Self {
        Self::empty()
            .with(attribution::STUDY)
            .with(compare::STUDY)
            .with(scaling::STUDY)
            .with(accuracy::STUDY)
            .with(replicate::STUDY)
    }

    /// # Panics
    ///
    /// If the name is taken, reserved or empty, or has an invalid character. Valid characters are lower-case ASCII
    /// letters, digits and hyphens.
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
