//! Studies: each asks a question, measures cases and answers with tables.
//!
//! A study is one file or folder that implements [`Study`], and one line in [`Studies::builtin`]. The command,
//! `study all` and the page of `sahara report` walk that list.

pub mod accuracy;
mod answers;
mod any_case;
mod any_study;
pub mod args;
pub mod attribution;
pub mod baseline;
mod bench;
pub mod break_even;
mod chosen;
pub mod compare;
pub mod costs;
pub mod counts;
pub mod crossover;
pub mod diff;
mod engine;
pub mod epoch;
mod epoch_args;
mod epoch_medians;
mod error;
mod found;
mod grouped;
pub mod history;
pub mod job;
pub mod journal;
pub mod kd_or_bvh;
mod least_squares;
mod list;
pub mod parameters;
pub mod partitions;
mod plan;
pub mod predictions;
pub mod process;
mod ray_source;
mod reference_structures;
pub mod replicate;
pub mod scaling;
mod screen;
mod seconds;
pub mod self_intersection;
pub mod sources;
mod stage;
mod status;
#[cfg(test)]
pub(crate) mod tests;
pub mod threads;
mod view_args;

use std::any::Any;

use serde::Serialize;
use serde::de::DeserializeOwned;
use serde_json::Value;

use epoch::Epoch;

use crate::measure::Provenance;
use crate::registry::Registry;
use crate::report::document::Block;
use crate::report::plot::Figure;
use crate::report::{Export, Statement, Table, to_json};

pub use answers::{Answers, AnyAnswer};
pub use any_case::AnyCase;
pub use any_study::AnyStudy;
pub use bench::guarded::{PANICKED, Refused, guarded};
pub use chosen::Chosen;
pub use engine::{Measured, Run};
pub use error::StudyError;
pub use found::Found;
pub use list::Studies;
pub use plan::{Effort, Measure, Plan, Planned, SceneId};
pub use ray_source::{RaySource, rays_or_all, replayed};
pub use reference_structures::{BRUTE_FORCE, REPORT_TREE, SAH_TREE, documented_defect, is_large, left_out};
pub use screen::Screen;
pub use seconds::Seconds;
pub use stage::Stage;
pub use status::{Status, Trouble};
pub use view_args::ViewArgs;

/// A question, and how it is answered. A type without values: all that a run is told is in [`Study::Args`].
pub trait Study: 'static {
    /// As written on the command line; also the name of its journal.
    const NAME: &'static str;
    /// What it asks, in one sentence.
    const QUESTION: &'static str;
    /// Whether the tables of a scene do not depend on the other scenes: they are printed as soon as the scene is
    /// measured.
    const SCENE_BY_SCENE: bool = false;
    /// Whether a journal is kept in the folder `runs` where no other is named.
    const KEPT: bool = true;
    /// Whether its answer is made from those of the other studies. It is then measured last.
    const LAST: bool = false;
    /// Whether a scene is nothing without a time of each of its structures: it is left out then.
    const WHOLE: bool = false;
    /// Whether it shows a scene with a stand-in beside the same one with its real mesh. Elsewhere the last
    /// one of which there is an answer counts.
    const BOTH_MESHES: bool = false;
    /// Draws what `--plot` writes, where the answer has a picture.
    const PLOT: Option<fn(&Self::Answer) -> Figure> = None;
    /// What `study all` measures, in words of the command line: scenes, which others may take the place of, then
    /// options.
    const FULL: &'static str = "";
    /// Likewise `study all --quick`.
    const QUICK: &'static str = "";

    /// Its options. Scenes are the only ones without a name.
    type Args: clap::Args;
    /// What is measured at a time, whatever else is, and kept as one file of the journal.
    type Case: Clone + Serialize + DeserializeOwned + 'static;
    /// What all cases come to.
    type Answer: Serialize + Send + Sync + 'static;

    /// The command that measures it for the page, which reads its journal.
    fn command() -> String {
        format!("sahara study {}{}", Self::NAME, if Self::KEPT { "" } else { " --dir runs" })
    }

    /// Why `study all` and its plan leave it out on this machine, in a sentence without the study's name; nothing where
    /// they do not.
    fn cannot_be_measured_here() -> Option<&'static str> {
        None
    }

    /// What is to be measured. No time is spent here, and whatever can be refused is refused.
    ///
    /// # Errors
    /// If the options name what is not there.
    fn plan(args: &Self::Args, registry: &Registry) -> anyhow::Result<Plan<Self::Case>>;

    /// The epoch that a case holds, and the number of its series where a scene has several: without a rule of its own
    /// the case itself, where that is an epoch. Before there is an answer the epochs of each series are
    /// [joined](epoch::join).
    fn epoch(case: &mut Self::Case) -> Option<(&mut Epoch, usize)> {
        let case: &mut dyn Any = case;
        case.downcast_mut().map(|epoch| (epoch, 0))
    }

    /// Epochs that are planned of a scene of so many triangles, where no scene has more than `most`.
    fn planned_epochs(most: usize, _triangles: usize) -> usize {
        most
    }

    /// The answer: a pure function of what was measured.
    fn answer(cases: &[Self::Case], context: &Context<Self>) -> Self::Answer;

    /// What is printed.
    fn tables(answer: &Self::Answer) -> Vec<Table>;

    /// What is printed after the tables of all scenes.
    fn summary(_: &Self::Answer) -> Vec<Table> {
        vec![]
    }

    /// What the columns of the tables mean.
    fn legend(_: &Self::Answer) -> Vec<String> {
        vec![]
    }

    /// What of all this is printed: the page and files have the rest as well.
    fn printed(answer: &Self::Answer) -> Printed {
        Printed { tables: Self::tables(answer), summary: Self::summary(answer), legend: Self::legend(answer) }
    }

    /// What is said last.
    fn remarks(_: &Self::Answer) -> Vec<String> {
        vec![]
    }

    /// The structures that have no time, or whose answers are wrong: without a rule of its own those of the epochs.
    fn troubles(cases: &[Self::Case]) -> Vec<Trouble> {
        let mut cases = cases.to_vec();
        epoch::troubles(cases.iter_mut().filter_map(Self::epoch).map(|(epoch, _)| &*epoch))
    }

    /// What spoilt the run, and what to do.
    fn warnings(_: &Self::Answer) -> Vec<String> {
        vec![]
    }

    /// The answer as tables for machines. The first one is written by `--export-csv`. The page shows the study as not
    /// measured where all of them are empty.
    fn data(answer: &Self::Answer) -> Vec<Data>;

    /// What was found, in sentences that the data choose and fill in, the most important first. The page, the paper and
    /// README print them.
    fn statements(_: &Self::Answer) -> Vec<Statement> {
        vec![]
    }

    /// What the page shows below the statements; `command` is the one that measured it.
    fn section(answer: &Self::Answer, command: &str) -> Vec<Block> {
        let tables = Self::tables(answer).into_iter().chain(Self::summary(answer));
        let notes = Self::legend(answer).into_iter().map(Block::Note);
        tables.map(|table| Block::table(table, command)).chain(notes).collect()
    }

    /// What `--export-json` writes.
    fn json(answer: &Self::Answer, provenance: &Provenance) -> Vec<u8> {
        to_json(&Export::new(Self::NAME, provenance, answer))
    }

    /// What `--export-csv` writes.
    fn csv(answer: &Self::Answer, provenance: &Provenance) -> Vec<u8> {
        let rows = Self::data(answer).into_iter().next().map_or(vec![], |data| data.rows);
        Export::new(Self::NAME, provenance, &rows[..]).to_csv()
    }

    /// Reads back what [`Study::json`] has written. Nothing if the value is no such thing, or is not read back.
    fn read(_: &Value) -> Option<serde_json::Result<Self::Answer>> {
        None
    }

    /// Adds a newer answer to an older one, and tells whether some of the older one is replaced. Without a rule of its
    /// own all of it is.
    fn merge(old: &mut Self::Answer, new: Self::Answer) -> bool {
        *old = new;
        true
    }

    /// The scenes that the page shows pictures of.
    fn scenes(_: &Self::Answer) -> Vec<SceneId> {
        vec![]
    }
}

/// What is printed of an answer.
pub struct Printed {
    /// As [`Study::tables`].
    pub tables: Vec<Table>,
    /// As [`Study::summary`].
    pub summary: Vec<Table>,
    /// As [`Study::legend`].
    pub legend: Vec<String>,
}

/// What an answer is made from besides the cases.
pub struct Context<'a, S: Study + ?Sized> {
    /// Of the run that measured the cases.
    pub provenance: &'a Provenance,
    /// The answers of the other studies; empty unless the study is [`Study::LAST`].
    pub others: &'a Answers,
    /// The options of this run; nothing where a journal is shown.
    pub args: Option<&'a S::Args>,
}

impl Answers {
    /// That of the study `S`, if there is one.
    pub fn of<S: Study>(&self) -> Option<&S::Answer> {
        self.get(S::NAME)?.downcast_ref()
    }
}

/// A table for machines.
#[derive(Clone, Debug, PartialEq)]
pub struct Data {
    /// Name of its files.
    pub name: &'static str,
    pub rows: Vec<Value>,
}

impl Data {
    /// One row for each of `rows`.
    pub fn new(name: &'static str, rows: &[impl Serialize]) -> Self {
        let row = |row| serde_json::to_value(row).expect("a row has text keys");
        Self { name, rows: rows.iter().map(row).collect() }
    }

    /// One row for each item of the lists `inner` of `outer`: these `fields` of what holds the list, then those of the
    /// item.
    pub fn nested(name: &'static str, outer: &[impl Serialize], fields: &[&str], inner: &str) -> Self {
        let mut rows = vec![];
        for outer in Self::new(name, outer).rows {
            for item in outer[inner].as_array().into_iter().flatten() {
                let own = fields.iter().map(|&field| (field.to_owned(), outer[field].clone()));
                rows.push(own.chain(item.as_object().expect("an item has fields").clone()).collect());
            }
        }
        Self { name, rows }
    }
}
