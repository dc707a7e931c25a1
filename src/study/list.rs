//! The one list of studies.

use std::marker::PhantomData;
use std::path::Path;

use super::any_study::Typed;
use super::journal::{self, CaseFile, JournalError};
use super::{
    Answers, AnyStudy, Found, Study, accuracy, attribution, compare, parameters, predictions, replicate, scaling,
};

/// Studies, in the order of the page.
pub struct Studies {
    list: Vec<Box<dyn AnyStudy>>,
}

impl Studies {
    pub fn empty() -> Self {
        Self { list: vec![] }
    }

    /// Those of this crate. A new one is one more line.
    pub fn builtin() -> Self {
        Self::empty()
            .with::<predictions::PredictionsStudy>()
            .with::<attribution::AttributionStudy>()
            .with::<compare::CompareStudy>()
            .with::<scaling::ScalingStudy>()
            .with::<parameters::ParametersStudy>()
            .with::<accuracy::AccuracyStudy>()
            .with::<replicate::ReplicateStudy>()
    }

    /// Adds a study.
    ///
    /// # Panics
    /// If its name is taken, is `all` or `plan`, or holds anything but lower-case letters, digits and hyphens.
    pub fn with<S: Study>(mut self) -> Self {
        let plain = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '-';
        assert!(
            !S::NAME.is_empty() && !["all", "plan"].contains(&S::NAME) && S::NAME.chars().all(plain),
            "the name {:?}",
            S::NAME
        );
        assert!(self.find(S::NAME).is_none(), "there is already a study {:?}", S::NAME);
        self.list.push(Box::new(Typed::<S>(PhantomData)));
        self
    }

    pub fn iter(&self) -> impl Iterator<Item = &dyn AnyStudy> {
        self.list.iter().map(|study| &**study)
    }

    /// Those that are made from the others come last.
    pub fn in_order_of_measuring(&self) -> Vec<&dyn AnyStudy> {
        let mut studies: Vec<&dyn AnyStudy> = self.iter().collect();
        studies.sort_by_key(|study| study.is_last());
        studies
    }

    pub fn find(&self, name: &str) -> Option<&dyn AnyStudy> {
        self.iter().find(|study| study.name() == name)
    }

    /// The answers of all journals in a folder but that of the study `without`.
    ///
    /// # Errors
    /// If a journal is there and cannot be read.
    pub fn answers(&self, folder: &Path, without: &str) -> Result<Answers, JournalError> {
        let mut answers = Answers::default();
        for study in self.iter().filter(|study| study.name() != without && !study.is_last()) {
            let folder = folder.join(study.name());
            if folder.is_dir() {
                let files = journal::files(&folder)?;
                let groups = journal::groups(files.iter().map(|path| CaseFile::read(path)).collect::<Result<_, _>>()?)?;
                if let Some(largest) = groups.last() {
                    let Found { answer, .. } = study.read_cases(largest, &Answers::default())?;
                    answers.insert(study.name(), answer);
                }
            }
        }
        Ok(answers)
    }
}

#[cfg(test)]
mod tests {
    use clap::Command;

    use super::*;
    use crate::study::{Chosen, Effort};

    #[test]
    fn what_study_all_measures_is_a_command_line_of_each_study() {
        for study in Studies::builtin().iter() {
            for effort in [Effort::Full, Effort::Quick] {
                for scenes in [vec![], vec!["a.ply".into()]] {
                    let taken = study.args(Chosen::Preset(effort, scenes));
                    assert!(taken.is_ok(), "{}: {:?}", study.name(), taken.err());
                }
            }
        }
    }

    /// Asked one after the other: none takes over what another one has.
    #[test]
    fn every_study_has_its_own_defaults_of_the_options_that_they_share() {
        let studies = Studies::builtin();
        for (name, defaults) in [
            ("compare", ["4", "1", "2"]),
            ("attribution", ["8", "3", "5"]),
            ("replicate", ["8", "3", "5"]),
            ("scaling", ["8", "3", "5"]),
        ] {
            let command = studies.find(name).expect("it is built in").augment(Command::new(name));
            let default =
                |option: &str| command.get_arguments().find(|arg| arg.get_id() == option)?.get_default_values().first();
            assert_eq!(["epochs", "runs", "budget"].map(|option| default(option).unwrap()), defaults, "{name}");
        }
    }
}
