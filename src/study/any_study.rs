//! What is known of a study without its types.

use std::any::Any;
use std::marker::PhantomData;
use std::path::{Path, PathBuf};

use clap::{Args, Command};
use serde_json::Value;

#[cfg(test)]
use super::Effort;
use super::chosen::{args, has_scenes};
use super::engine::{Measured, Run, measure};
use super::epoch::join;
use super::job::{self, Done, Job};
use super::journal::{CaseFile, Group, JournalError};
use super::process;
use super::{Answers, AnyAnswer, Chosen, Context, Data, Planned, SceneId, Screen, Study};
use crate::measure::Provenance;
use crate::registry::Registry;
use crate::report::Statement;
use crate::report::document::Block;
use crate::report::plot::Figure;

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
        check: &mut dyn FnMut(&[PathBuf]) -> anyhow::Result<()>,
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
    /// Adds its answer, newer than what is there; tells whether some of that is replaced.
    fn add(&self, answers: &mut Answers, answer: AnyAnswer) -> bool {
        match answers.get_mut(self.name()) {
            Some(old) => self.merge(old, answer),
            None => {
                answers.insert(self.name(), answer);
                false
            }
        }
    }
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

/// A study whose types are known.
pub(super) struct Typed<S>(pub PhantomData<fn() -> S>);

fn own<S: Study>(answer: &dyn Any) -> &S::Answer {
    answer.downcast_ref().expect("the answer is of this study")
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
        check: &mut dyn FnMut(&[PathBuf]) -> anyhow::Result<()>,
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
