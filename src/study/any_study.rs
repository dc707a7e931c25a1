//! What is known of a study without its types.

use std::any::Any;
use std::ffi::OsString;
use std::marker::PhantomData;

use clap::{Args, Command};
use serde_json::Value;

use super::any_case::{self, AnyCase};
use super::chosen::{args, has_scenes, preset};
use super::journal::Read;
use super::{Answers, AnyAnswer, Chosen, Context, Data, Effort, Plan, Printed, SceneId, Study, Trouble};
use crate::measure::Provenance;
use crate::registry::Registry;
use crate::report::document::Block;
use crate::report::plot::Figure;
use crate::report::{Statement, Table};

/// Hands what is made of an answer, a function of [`Study`] each, to another macro.
macro_rules! views {
    ($each:ident) => {
        $each! {
            printed() -> Printed;
            tables() -> Vec<Table>;
            summary() -> Vec<Table>;
            legend() -> Vec<String>;
            remarks() -> Vec<String>;
            warnings() -> Vec<String>;
            data() -> Vec<Data>;
            statements() -> Vec<Statement>;
            section(command: &str) -> Vec<Block>;
            scenes() -> Vec<SceneId>;
            json(provenance: &Provenance) -> Vec<u8>;
            csv(provenance: &Provenance) -> Vec<u8>;
        }
    };
}

macro_rules! declared {
    ($($view:ident($($more:ident: $of:ty)?) -> $made:ty;)*) => {
        $(
            #[doc = concat!("[`Study::", stringify!($view), "`].")]
            fn $view(&self, answer: &dyn Any $(, $more: $of)?) -> $made;
        )*
    };
}

macro_rules! forwarded {
    ($($view:ident($($more:ident: $of:ty)?) -> $made:ty;)*) => {
        $(
            fn $view(&self, answer: &dyn Any $(, $more: $of)?) -> $made {
                S::$view(own::<S>(answer) $(, $more)?)
            }
        )*
    };
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
    /// [`Study::SCENE_BY_SCENE`].
    fn is_scene_by_scene(&self) -> bool;
    /// [`Study::WHOLE`].
    fn is_whole(&self) -> bool;
    /// [`Study::BOTH_MESHES`].
    fn shows_both_meshes(&self) -> bool;
    /// Whether there is a [`Study::PLOT`].
    fn has_plot(&self) -> bool;
    /// [`Study::PLOT`] of an answer.
    fn plot(&self, answer: &dyn Any) -> Option<Figure>;
    /// [`Study::cannot_be_measured_here`].
    fn cannot_be_measured_here(&self) -> Option<&'static str>;
    /// Adds the options of the study to a command.
    fn augment(&self, command: Command) -> Command;
    /// Whether its options name scenes.
    fn names_scenes(&self) -> bool;
    /// What `study all` measures of it, in words of its command line; on these scenes, where there are any.
    fn preset(&self, effort: Effort, scenes: &[OsString]) -> Vec<OsString>;
    /// Its options.
    ///
    /// # Errors
    /// If what is chosen is not taken.
    fn args(&self, chosen: Chosen) -> anyhow::Result<Box<dyn Any>>;
    /// [`Study::plan`].
    ///
    /// # Errors
    /// As that.
    fn plan(&self, args: &dyn Any, registry: &Registry) -> anyhow::Result<Plan<Box<dyn AnyCase>>>;
    /// [`Study::planned_epochs`].
    fn planned_epochs(&self, most: usize, triangles: usize) -> usize;
    /// How its cases are read.
    fn reader(&self) -> Read<Box<dyn AnyCase>>;
    /// [`Study::answer`].
    fn answer(
        &self,
        cases: &[Box<dyn AnyCase>],
        provenance: &Provenance,
        others: &Answers,
        args: Option<&dyn Any>,
    ) -> AnyAnswer;
    /// [`Study::troubles`].
    fn troubles(&self, cases: &[Box<dyn AnyCase>]) -> Vec<Trouble>;
    /// [`Study::read`].
    fn read_export(&self, value: &Value) -> Option<serde_json::Result<AnyAnswer>>;
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
    views!(declared);
}

/// A study whose types are known.
pub(super) struct Typed<S>(pub PhantomData<fn() -> S>);

fn own_args<S: Study>(args: &dyn Any) -> &S::Args {
    args.downcast_ref().expect("the options are of this study")
}

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

    fn is_scene_by_scene(&self) -> bool {
        S::SCENE_BY_SCENE
    }

    fn is_whole(&self) -> bool {
        S::WHOLE
    }

    fn shows_both_meshes(&self) -> bool {
        S::BOTH_MESHES
    }

    fn has_plot(&self) -> bool {
        S::PLOT.is_some()
    }

    fn plot(&self, answer: &dyn Any) -> Option<Figure> {
        S::PLOT.map(|plot| plot(own::<S>(answer)))
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

    fn preset(&self, effort: Effort, scenes: &[OsString]) -> Vec<OsString> {
        preset::<S>(effort, scenes)
    }

    fn args(&self, chosen: Chosen) -> anyhow::Result<Box<dyn Any>> {
        Ok(Box::new(args::<S>(chosen)?))
    }

    fn plan(&self, args: &dyn Any, registry: &Registry) -> anyhow::Result<Plan<Box<dyn AnyCase>>> {
        Ok(S::plan(own_args::<S>(args), registry)?.map(any_case::of::<S>))
    }

    fn planned_epochs(&self, most: usize, triangles: usize) -> usize {
        S::planned_epochs(most, triangles)
    }

    fn reader(&self) -> Read<Box<dyn AnyCase>> {
        any_case::read::<S>
    }

    fn answer(
        &self,
        cases: &[Box<dyn AnyCase>],
        provenance: &Provenance,
        others: &Answers,
        args: Option<&dyn Any>,
    ) -> AnyAnswer {
        let context = Context { provenance, others, args: args.map(own_args::<S>) };
        Box::new(S::answer(&any_case::typed::<S>(cases), &context))
    }

    fn troubles(&self, cases: &[Box<dyn AnyCase>]) -> Vec<Trouble> {
        S::troubles(&any_case::typed::<S>(cases))
    }

    fn read_export(&self, value: &Value) -> Option<serde_json::Result<AnyAnswer>> {
        S::read(value).map(|read| read.map(|answer| Box::new(answer) as AnyAnswer))
    }

    fn merge(&self, old: &mut AnyAnswer, new: AnyAnswer) -> bool {
        let new = (new as Box<dyn Any>).downcast::<S::Answer>().expect("the answer is of this study");
        S::merge((**old).downcast_mut().expect("the answer is of this study"), *new)
    }

    views!(forwarded);
}
