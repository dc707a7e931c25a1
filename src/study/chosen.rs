//! The options of a study, whatever they are chosen by.

use std::ffi::OsString;

use clap::{ArgMatches, Args, Command, FromArgMatches};

use super::{Effort, Study};

/// Where the options of a study come from.
pub enum Chosen<'a> {
    /// A command line.
    Matches(&'a ArgMatches),
    /// The defaults of its command.
    Defaults,
    /// `study all`, on these scenes where there are any.
    Preset(Effort, Vec<OsString>),
}

fn command<S: Study>() -> Command {
    S::Args::augment_args(Command::new(S::NAME).no_binary_name(true))
}

/// Whether the options of a study name scenes.
pub(super) fn has_scenes<S: Study>() -> bool {
    command::<S>().get_positionals().next().is_some()
}

/// What `study all` measures of a study, in words of its command line: scenes, those given where there are any, then options.
pub(super) fn preset<S: Study>(effort: Effort, scenes: &[OsString]) -> Vec<OsString> {
    let own = match effort {
        Effort::Full => S::FULL,
        Effort::Quick => S::QUICK,
    };
    let own = own.split_whitespace();
    if scenes.is_empty() || !has_scenes::<S>() {
        return own.map(OsString::from).collect();
    }
    let options = own.skip_while(|word| !word.starts_with('-')).map(OsString::from);
    scenes.iter().cloned().chain(options).collect()
}

/// The options of a study.
///
/// # Errors
/// If they are not those of its command.
pub(super) fn args<S: Study>(chosen: Chosen) -> anyhow::Result<S::Args> {
    let words = match chosen {
        Chosen::Matches(matches) => return Ok(S::Args::from_arg_matches(matches)?),
        Chosen::Defaults => vec![],
        Chosen::Preset(effort, scenes) => preset::<S>(effort, &scenes),
    };
    Ok(S::Args::from_arg_matches(&command::<S>().try_get_matches_from(words)?)?)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::compare::CompareStudy;

    #[test]
    fn defaults_are_those_of_the_command_and_not_of_study_all() {
        let structures = |chosen| args::<CompareStudy>(chosen).unwrap().structures.structure;
        assert!(structures(Chosen::Defaults).is_empty());
        assert!(!structures(Chosen::Preset(Effort::Full, vec![])).is_empty());
    }
}
