//! Studies: each asks a question, plans cases and reports on what was measured.
//!
//! A [`Study`] is a value: two functions and their options. Measuring is not its business: `engine` measures the cases
//! of a plan that the journal lacks, one [`Case`] a process, and hands the [`Dataset`] to the study's report.

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
mod stage;
mod status;
#[cfg(test)]
mod tests;
mod verdict;
mod whole_times;

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
pub use screen::Screen;
pub use stage::Stage;
pub use status::Status;
pub use verdict::Verdict;

/// A question, how it is measured, and what is said of what was measured.
pub struct Study {
    /// As written on the command line; also the name of its journal.
    pub name: &'static str,
    /// What it finds out, in one line.
    pub question: &'static str,
    /// Arguments of `study all`.
    pub presets: Presets,
    /// Its options. Scenes are the only ones without a name.
    pub options: fn() -> Command,
    /// What is to be measured. No time is spent here, and whatever can be refused is refused.
    pub plan: fn(&ArgMatches, &Registry) -> anyhow::Result<Plan>,
    /// A pure function of what was measured. The options are those of the run, or the defaults where a journal or an
    /// export is shown.
    pub report: fn(&Dataset, &ArgMatches) -> Report,
}

/// What `study all` measures of a study, in words of its command line: scenes, which others may take the place of, then
/// options.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Presets {
    pub full: &'static str,
    /// A few minutes for trying out.
    pub quick: &'static str,
}

/// How much `study all` measures.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Effort {
    Full,
    /// A few minutes for trying out: few scenes, rays and epochs.
    Quick,
}

impl Study {
    /// Its options alone, without the name of a program.
    fn command(&self) -> Command {
        (self.options)().no_binary_name(true)
    }

    /// Its options as these words give them.
    ///
    /// # Errors
    /// If they are not those of its command.
    pub fn matches<W: AsRef<OsStr>>(&self, words: &[W]) -> Result<ArgMatches, clap::Error> {
        self.command().try_get_matches_from(words.iter().map(OsString::from))
    }

    /// Its options by default.
    ///
    /// # Panics
    /// If an option has no default.
    pub fn defaults(&self) -> ArgMatches {
        self.matches::<OsString>(&[]).unwrap_or_else(|error| panic!("study {}: {error}", self.name))
    }

    /// Whether its options name scenes.
    pub fn names_scenes(&self) -> bool {
        self.command().get_positionals().next().is_some()
    }

    /// What `study all` measures of it, in words of its command line; on these scenes, where there are any.
    pub fn preset(&self, effort: Effort, scenes: &[OsString]) -> Vec<OsString> {
        let own = match effort {
            Effort::Full => self.presets.full,
            Effort::Quick => self.presets.quick,
        };
        let own = own.split_whitespace();
        if scenes.is_empty() || !self.names_scenes() {
            return own.map(OsString::from).collect();
        }
        let options = own.skip_while(|word| !word.starts_with('-')).map(OsString::from);
        scenes.iter().cloned().chain(options).collect()
    }

    /// The command that measures it into the folder `runs`, which `sahara report` reads.
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

    /// Those of this crate. A new one is one more line.
    pub fn builtin() -> Self {
        Self::empty()
            .with(attribution::STUDY)
            .with(compare::STUDY)
            .with(scaling::STUDY)
            .with(accuracy::STUDY)
            .with(replicate::STUDY)
    }

    /// Adds a study.
    ///
    /// # Panics
    /// If its name is taken, is `all` or `plan`, or holds anything but lower-case letters, digits and hyphens.
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
