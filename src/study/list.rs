//! The one list of studies, and what is known of each without its types.

use std::any::Any;
use std::collections::BTreeMap;
use std::marker::PhantomData;
use std::path::Path;

use clap::{ArgMatches, Args, Command, FromArgMatches};
use serde_json::Value;

use super::engine::{Measured, Run, measure};
use super::epoch::join;
use super::job::{self, Done, Job};
use super::journal::{self, CaseFile, Group, JournalError};
use super::process;
use super::{
    Context, Data, Effort, Planned, SceneId, Screen, Study, accuracy, attribution, break_even, compare, costs, counts,
    crossover, kd_or_bvh, parameters, partitions, predictions, replicate, scaling, self_intersection, threads,
};
use crate::measure::Provenance;
use crate::registry::Registry;
use crate::report::Statement;
use crate::report::document::Block;
use crate::report::plot::Figure;

/// An answer whose type is not known.
pub type AnyAnswer = Box<dyn Any + Send + Sync>;

/// Studies, in the order of the page.
pub struct Studies {
    list: Vec<Box<dyn AnyStudy>>,
}

impl Studies {
    /// None at all.
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
            .with::<threads::ThreadsStudy>()
            .with::<break_even::BreakEvenStudy>()
            .with::<crossover::CrossoverStudy>()
            .with::<kd_or_bvh::KdOrBvhStudy>()
            .with::<costs::CostsStudy>()
            .with::<parameters::ParametersStudy>()
            .with::<accuracy::AccuracyStudy>()
            .with::<partitions::PartitionsStudy>()
            .with::<counts::CountsStudy>()
            .with::<self_intersection::SelfIntersectionStudy>()
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

    /// All of them.
    pub fn iter(&self) -> impl Iterator<Item = &dyn AnyStudy> {
        self.list.iter().map(|study| &**study)
    }

    /// Those that are made from the others come last.
    pub fn in_order_of_measuring(&self) -> Vec<&dyn AnyStudy> {
        let mut studies: Vec<&dyn AnyStudy> = self.iter().collect();
        studies.sort_by_key(|study| study.is_last());
        studies
    }

    /// The study `name`.
    pub fn find(&self, name: &str) -> Option<&dyn AnyStudy> {
        self.iter().find(|study| study.name() == name)
    }
}

/// Where the options of a study come from.
pub enum Chosen<'a> {
    /// A command line.
    Matches(&'a ArgMatches),
    /// The defaults of its command.
    Defaults,
    /// `study all`, on these scenes where there are any.
    Preset(Effort, Vec<String>),
}

/// What is read of cases.
pub struct Found {
    pub answer: AnyAnswer,
    /// What is missing or left out, a sentence each.
    pub notes: Vec<String>,
}

/// A study whose types are not known. The answers that it takes are its own.
pub trait AnyStudy: Send + Sync {
    /// [`Study::NAME`].
    fn name(&self) -> &'static str;
    /// [`Study::QUESTION`].
    fn question(&self) -> &'static str;
    /// [`Study::command`].
    fn command(&self) -> String;
    /// [`Study::KEPT`].
    fn is_kept(&self) -> bool;
    /// [`Study::LAST`].
    fn is_last(&self) -> bool;
    /// [`Study::cannot_be_measured_here`].
    fn cannot_be_measured_here(&self) -> Option<&'static str>;
    /// Adds the options of the study to a command.
    fn augment(&self, command: Command) -> Command;
    /// Whether its options name scenes.
    fn names_scenes(&self) -> bool;
    /// That its options take what `study all` measures.
    #[cfg(test)]
    fn takes_presets(&self) -> anyhow::Result<()>;
    /// The cases that would be measured.
    ///
    /// # Errors
    /// As [`Study::plan`].
    fn planned(&self, chosen: Chosen, registry: &Registry) -> anyhow::Result<Vec<Planned>>;
    /// Measures and answers. `check` is told which files are read, before anything is measured.
    ///
    /// # Errors
    /// As [`Study::plan`], as `check`, and if the journal cannot be used or nothing can be measured.
    fn run(
        &self,
        chosen: Chosen,
        run: &mut Run,
        check: &mut dyn FnMut(&[std::path::PathBuf]) -> anyhow::Result<()>,
    ) -> anyhow::Result<Measured>;
    /// What a process with a job does: measures that one case, and says so on standard output.
    ///
    /// # Errors
    /// If that is closed.
    fn answer_job(&self, chosen: Chosen, registry: &Registry, job: &Job) -> anyhow::Result<()>;
    /// What a process with a job and a file does: as [`job::write`].
    ///
    /// # Errors
    /// As [`Study::plan`] and [`job::write`].
    fn write_job(
        &self,
        chosen: Chosen,
        registry: &Registry,
        job: &Job,
        out: &Path,
        screen: &mut dyn Screen,
    ) -> anyhow::Result<Done>;
    /// The answer to cases of one build and machine.
    ///
    /// # Errors
    /// If one of them is not of this study.
    fn read_cases(&self, group: &Group<Value>, others: &Answers) -> Result<Found, JournalError>;
    /// [`Study::read`].
    fn read_export(&self, value: &Value) -> Option<serde_json::Result<AnyAnswer>>;
    /// The answer without any case.
    fn answer_alone(&self, provenance: &Provenance, others: &Answers) -> AnyAnswer;
    /// [`Study::merge`].
    fn merge(&self, old: &mut AnyAnswer, new: AnyAnswer) -> bool;
    /// [`Study::data`].
    fn data(&self, answer: &dyn Any) -> Vec<Data>;
    /// [`Study::statements`].
    fn statements(&self, answer: &dyn Any) -> Vec<Statement>;
    /// [`Study::section`].
    fn section(&self, answer: &dyn Any, command: &str) -> Vec<Block>;
    /// [`Study::scenes`].
    fn scenes(&self, answer: &dyn Any) -> Vec<SceneId>;
    /// [`Study::plot`].
    fn plot(&self, answer: &dyn Any) -> Option<Figure>;
    /// [`Study::json`].
    fn json(&self, answer: &dyn Any, provenance: &Provenance) -> Vec<u8>;
    /// [`Study::csv`].
    fn csv(&self, answer: &dyn Any, provenance: &Provenance) -> Vec<u8>;
}

struct Typed<S>(PhantomData<fn() -> S>);

fn own<S: Study>(answer: &dyn Any) -> &S::Answer {
    answer.downcast_ref().expect("the answer is of this study")
}

fn command<S: Study>() -> Command {
    S::Args::augment_args(Command::new(S::NAME).no_binary_name(true))
}

fn has_scenes<S: Study>() -> bool {
    command::<S>().get_positionals().next().is_some()
}

pub(super) fn args<S: Study>(chosen: Chosen) -> anyhow::Result<S::Args> {
    let (preset, scenes) = match chosen {
        Chosen::Matches(matches) => return Ok(S::Args::from_arg_matches(matches)?),
        Chosen::Defaults => ("", vec![]),
        Chosen::Preset(Effort::Full, scenes) => (S::FULL, scenes),
        Chosen::Preset(Effort::Quick, scenes) => (S::QUICK, scenes),
    };
    let mut words: Vec<String> = preset.split_whitespace().map(String::from).collect();
    if has_scenes::<S>() && !scenes.is_empty() {
        words = words.into_iter().skip_while(|word| !word.starts_with('-')).collect();
        words.extend(std::iter::once("--".into()).chain(scenes));
    }
    Ok(S::Args::from_arg_matches(&command::<S>().try_get_matches_from(words)?)?)
}

impl<S: Study> AnyStudy for Typed<S> {
    fn name(&self) -> &'static str {
        S::NAME
    }

    fn question(&self) -> &'static str {
        S::QUESTION
    }

    fn command(&self) -> String {
        S::command()
    }

    fn is_kept(&self) -> bool {
        S::KEPT
    }

    fn is_last(&self) -> bool {
        S::LAST
    }

    fn cannot_be_measured_here(&self) -> Option<&'static str> {
        S::cannot_be_measured_here()
    }

    fn augment(&self, command: Command) -> Command {
        S::Args::augment_args(command)
    }

    fn names_scenes(&self) -> bool {
        has_scenes::<S>()
    }

    #[cfg(test)]
    fn takes_presets(&self) -> anyhow::Result<()> {
        [Effort::Full, Effort::Quick].into_iter().try_for_each(|effort| {
            args::<S>(Chosen::Preset(effort, vec![]))?;
            args::<S>(Chosen::Preset(effort, vec!["a.ply".into()])).map(drop)
        })
    }

    fn planned(&self, chosen: Chosen, registry: &Registry) -> anyhow::Result<Vec<Planned>> {
        Ok(S::plan(&args::<S>(chosen)?, registry)?.cases)
    }

    fn run(
        &self,
        chosen: Chosen,
        run: &mut Run,
        check: &mut dyn FnMut(&[std::path::PathBuf]) -> anyhow::Result<()>,
    ) -> anyhow::Result<Measured> {
        let args = args::<S>(chosen)?;
        let plan = S::plan(&args, run.registry)?;
        check(&plan.inputs)?;
        measure::<S>(&args, &plan, run)
    }

    fn answer_job(&self, chosen: Chosen, registry: &Registry, job: &Job) -> anyhow::Result<()> {
        Ok(process::answer(|| S::plan(&args::<S>(chosen)?, registry), job)?)
    }

    fn write_job(
        &self,
        chosen: Chosen,
        registry: &Registry,
        job: &Job,
        out: &Path,
        screen: &mut dyn Screen,
    ) -> anyhow::Result<Done> {
        Ok(job::write(&S::plan(&args::<S>(chosen)?, registry)?, job, out, screen)?)
    }

    fn read_cases(&self, group: &Group<Value>, others: &Answers) -> Result<Found, JournalError> {
        let typed = |file: &CaseFile<Value>| Ok(file.clone().typed::<S::Case>()?.case);
        let mut cases = group.files.iter().map(typed).collect::<Result<Vec<S::Case>, JournalError>>()?;
        // As they come from many machines in no order: small scenes first.
        cases.sort_by_cached_key(|case| S::epoch(&mut case.clone()).map(|(epoch, _)| epoch.triangles));
        let joined = join(cases, S::epoch, S::WHOLE);
        let failures = joined.failures.iter().map(|failure| format!("{failure}; the scene is left out."));
        let notes = failures.chain(joined.unchecked).chain(joined.missing);
        let answer = S::answer(&joined.cases, &Context { provenance: &group.provenance, others, args: None });
        Ok(Found { notes: notes.collect(), answer: Box::new(answer) })
    }

    fn read_export(&self, value: &Value) -> Option<serde_json::Result<AnyAnswer>> {
        S::read(value).map(|read| read.map(|answer| Box::new(answer) as AnyAnswer))
    }

    fn answer_alone(&self, provenance: &Provenance, others: &Answers) -> AnyAnswer {
        Box::new(S::answer(&[], &Context { provenance, others, args: None }))
    }

    fn merge(&self, old: &mut AnyAnswer, new: AnyAnswer) -> bool {
        let new = (new as Box<dyn Any>).downcast::<S::Answer>().expect("the answer is of this study");
        S::merge((**old).downcast_mut().expect("the answer is of this study"), *new)
    }

    fn data(&self, answer: &dyn Any) -> Vec<Data> {
        S::data(own::<S>(answer))
    }

    fn statements(&self, answer: &dyn Any) -> Vec<Statement> {
        S::statements(own::<S>(answer))
    }

    fn section(&self, answer: &dyn Any, command: &str) -> Vec<Block> {
        S::section(own::<S>(answer), command)
    }

    fn scenes(&self, answer: &dyn Any) -> Vec<SceneId> {
        S::scenes(own::<S>(answer))
    }

    fn plot(&self, answer: &dyn Any) -> Option<Figure> {
        S::plot(own::<S>(answer))
    }

    fn json(&self, answer: &dyn Any, provenance: &Provenance) -> Vec<u8> {
        S::json(own::<S>(answer), provenance)
    }

    fn csv(&self, answer: &dyn Any, provenance: &Provenance) -> Vec<u8> {
        S::csv(own::<S>(answer), provenance)
    }
}

/// Answers by the names of their studies.
#[derive(Default)]
pub struct Answers {
    by_name: BTreeMap<&'static str, AnyAnswer>,
}

impl Answers {
    /// Those of all journals in a folder but that of the study `without`.
    ///
    /// # Errors
    /// If a journal is there and cannot be read.
    pub fn read(folder: &Path, studies: &Studies, without: &str) -> Result<Self, JournalError> {
        let mut answers = Self::default();
        for study in studies.iter().filter(|study| study.name() != without && !study.is_last()) {
            let folder = folder.join(study.name());
            if folder.is_dir() {
                let files = journal::files(&folder)?;
                let groups = journal::groups(files.iter().map(|path| CaseFile::read(path)).collect::<Result<_, _>>()?)?;
                if let Some(largest) = groups.last() {
                    let Found { answer, .. } = study.read_cases(largest, &Self::default())?;
                    answers.by_name.insert(study.name(), answer);
                }
            }
        }
        Ok(answers)
    }

    /// The answer of the study `S`, if there is one.
    pub fn of<S: Study>(&self) -> Option<&S::Answer> {
        (**self.by_name.get(S::NAME)?).downcast_ref()
    }

    /// That of the study `name`.
    pub fn get(&self, name: &str) -> Option<&dyn Any> {
        self.by_name.get(name).map(|answer| &**answer as &dyn Any)
    }

    /// Adds an answer of `study`, newer than what is there; tells whether some of that is replaced.
    pub fn add(&mut self, study: &dyn AnyStudy, answer: AnyAnswer) -> bool {
        match self.by_name.get_mut(study.name()) {
            Some(old) => study.merge(old, answer),
            None => self.by_name.insert(study.name(), answer).is_some(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::compare::CompareStudy;

    #[test]
    fn what_study_all_measures_is_a_command_line_of_each_study() {
        for study in Studies::builtin().iter() {
            study.takes_presets().unwrap_or_else(|error| panic!("{}: {error}", study.name()));
        }
    }

    /// Asked one after the other: none takes over what another one has.
    #[test]
    fn every_study_has_its_own_defaults_of_the_options_that_they_share() {
        let studies = Studies::builtin();
        for (name, defaults) in [
            ("compare", ["4", "1", "2"]),
            ("attribution", ["5", "3", "8"]),
            ("partitions", ["3", "5", "40"]),
            ("replicate", ["4", "3", "8"]),
            ("scaling", ["3", "3", "8"]),
            ("threads", ["3", "3", "4"]),
        ] {
            let command = studies.find(name).expect("it is built in").augment(Command::new(name));
            let default =
                |option: &str| command.get_arguments().find(|arg| arg.get_id() == option)?.get_default_values().first();
            assert_eq!(["epochs", "runs", "budget"].map(|option| default(option).unwrap()), defaults, "{name}");
        }
    }

    #[test]
    fn defaults_are_those_of_the_command_and_not_of_study_all() {
        let structures = |chosen| args::<CompareStudy>(chosen).unwrap().structures.structure;
        assert!(structures(Chosen::Defaults).is_empty());
        assert!(!structures(Chosen::Preset(Effort::Full, vec![])).is_empty());
    }
}
