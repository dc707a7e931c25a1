//! `parameters`: the report's sweep of its leaf limit and match threshold; which differences are real?
//!
//! The report prints single runs. Here every setting is built anew in several epochs and timed in interleaved rounds on all rays
//! of the picture, the setting of the report's main table twice: what these twins differ by is the A/A noise. Cube has fewer
//! triangles than every leaf limit, so that all its settings are the same tree: the control.

mod result;
mod section;
mod table;
#[cfg(test)]
mod tests;

use std::ffi::{OsStr, OsString};

use super::args::{Measuring, Scenes};
use super::epoch::{Asked, Epoch};
use super::replicate::original::{SWEEP, SweepRow, main_scenes};
use super::{Context, Data, Plan, REPORT_TREE, Study};
use crate::registry::{Choice, ChoiceError, Registry};
use crate::report::document::Block;
use crate::report::{Statement, Table};
use crate::scene::{Builtin, Scene};

pub use result::{Difference, Parameters, Setting, result};
pub use table::tables;

/// The setting of the report's main table: the others are held against it.
pub const DEFAULT: (u32, f32) = (100, 0.7);

pub(super) fn default_row() -> usize {
    SWEEP.iter().position(is_default).expect("the sweep holds the default")
}

fn is_default(row: &SweepRow) -> bool {
    (row.leaf, row.threshold) == DEFAULT
}

/// The settings of the sweep in their order, then the twin of the default.
pub(super) fn structures(registry: &Registry) -> Result<Vec<Choice>, ChoiceError> {
    let rows = SWEEP.iter().chain([&SWEEP[default_row()]]);
    let spec = |row: &SweepRow| format!("{REPORT_TREE}:leaf={},threshold={}", row.leaf, row.threshold);
    rows.map(|row| registry.choose(&spec(row))).collect()
}

pub struct ParametersStudy;

#[derive(Clone, Debug, clap::Args)]
pub struct ParametersArgs {
    // Of the report's sweep; all of them if none is named.
    #[command(flatten)]
    scenes: Scenes,
    #[command(flatten)]
    measuring: Measuring,
}

impl Study for ParametersStudy {
    const NAME: &'static str = "parameters";
    const QUESTION: &'static str = "Which differences of the report's sweep of leaf limit and threshold are real?";
    const WHOLE: bool = true;
    const QUICK: &'static str = "cube torus --epochs 2 --runs 2 --budget 1";

    type Args = ParametersArgs;
    type Case = Epoch;
    type Answer = Parameters;

    fn plan(args: &ParametersArgs, registry: &Registry) -> anyhow::Result<Plan<Epoch>> {
        let all = main_scenes();
        let named = args.scenes.scenes.iter().map(OsString::as_os_str);
        let named: Vec<&OsStr> = if named.len() == 0 { all.iter().map(OsStr::new).collect() } else { named.collect() };
        let mut chosen: Vec<Scene> = vec![];
        for name in named {
            let builtin = Builtin::find(name)?;
            anyhow::ensure!(
                all.contains(&builtin.name),
                "{} is not in the report's sweep; in it are: {}",
                builtin.name,
                all.join(", ")
            );
            if chosen.iter().all(|scene| scene.name != builtin.name) {
                chosen.push(builtin.scene(None)?);
            }
        }
        let settings = args.measuring.settings(registry, structures(registry)?, Asked::Picture)?;
        Ok(settings.plan(chosen, args.measuring.epochs))
    }

    fn answer(cases: &[Epoch], _: &Context<Self>) -> Parameters {
        result(cases)
    }

    fn tables(answer: &Parameters) -> Vec<Table> {
        tables(answer)
    }

    fn data(answer: &Parameters) -> Vec<Data> {
        vec![Data::new(Self::NAME, &answer.settings)]
    }

    fn statements(answer: &Parameters) -> Vec<Statement> {
        section::statements(answer)
    }

    fn section(answer: &Parameters, command: &str) -> Vec<Block> {
        section::blocks(answer, command)
    }
}
