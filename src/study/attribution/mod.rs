//! `attribution`: what of a SAH tree's speed is due to the split plane, what to the stop rule and what to the traversal?
//!
//! One kind of tree in every combination of six planes, three stop rules and two traversals, over one triangle test, on the
//! same rays: the factorial [`design`]. In every epoch all trees are built anew and timed in rounds, each round every tree once, in
//! random order; the report's tree and the SAH tree are built twice, and what the twins differ by is the A/A noise. A case of the
//! journal is one epoch of one scene.

pub mod design;
pub mod effects;
mod result;
mod section;
mod table;
#[cfg(test)]
pub(crate) mod tests;

use super::args::{Measuring, QUICK_EPOCHS, ScenesAndMeshes};
use super::epoch::{Asked, Epoch};
use super::epoch_args::plan_on;
use super::{Context, Data, Plan, Study, rays_or_all, sources};
use crate::registry::{Choice, ChoiceError, Registry};
use crate::report::document::Block;
use crate::report::{Statement, Table};
use crate::scene::WorkloadKind;
use design::Treatment;

pub use result::{Attribution, CellResult, Effect, Part, Row, Split, Term, result, rows};
pub use section::{HARD, bars, hard, sentences};
pub use table::{headlines, tables};

/// The cells of the design in their order, then the twins of the report's tree and of the SAH tree, over one triangle test.
fn structures(registry: &Registry, test: &str) -> Result<Vec<Choice>, ChoiceError> {
    let cells = Treatment::all().into_iter().chain([Treatment::REPORT, Treatment::SAH]);
    cells.map(|cell| registry.choose(&cell.spec(test))).collect()
}

pub struct AttributionStudy;

#[derive(Clone, Debug, clap::Args)]
pub struct AttributionArgs {
    #[command(flatten)]
    scenes: ScenesAndMeshes,
    /// The kind of rays
    #[arg(long, short, value_name = "KIND", default_value = "primary")]
    workload: WorkloadKind,
    /// Rays of a workload that are timed, at most, in whole tiles of the scene's picture
    #[arg(long, value_name = "N|all", default_value = "all", value_parser = rays_or_all)]
    rays: usize,
    /// The triangle test of all trees
    #[arg(long, short, value_name = "NAME", default_value = TEST)]
    test: String,
    // Claims are judged by these numbers, all of them together: few epochs leave what is sure to luck.
    #[command(flatten)]
    measuring: Measuring<8, 3, 5>,
}

const TEST: &str = "exact";

impl Study for AttributionStudy {
    const NAME: &'static str = "attribution";
    const QUESTION: &'static str =
        "What of the SAH tree's speed is due to the stop rule, what to the plane and what to the traversal?";
    const WHOLE: bool = true;
    const BOTH_MESHES: bool = true;
    const QUICK: &'static str = QUICK_EPOCHS;

    type Args = AttributionArgs;
    type Case = Epoch;
    type Answer = Vec<Attribution>;

    fn plan(args: &AttributionArgs, registry: &Registry) -> anyhow::Result<Plan<Epoch>> {
        sources::known_tests(registry, std::slice::from_ref(&args.test))?;
        let asked = Asked::Kinds(vec![args.workload], args.rays);
        let settings = args.measuring.settings(registry, structures(registry, &args.test)?, asked)?;
        plan_on(&args.scenes, |scenes| settings.plan(scenes, args.measuring.epochs))
    }

    fn answer(cases: &[Epoch], _: &Context<Self>) -> Vec<Attribution> {
        result(cases)
    }

    fn tables(answer: &Vec<Attribution>) -> Vec<Table> {
        answer.iter().flat_map(tables).collect()
    }

    fn summary(answer: &Vec<Attribution>) -> Vec<Table> {
        vec![headlines(answer)]
    }

    fn data(answer: &Vec<Attribution>) -> Vec<Data> {
        vec![Data::new(Self::NAME, &rows(answer))]
    }

    fn statements(answer: &Vec<Attribution>) -> Vec<Statement> {
        section::statements(answer)
    }

    fn section(answer: &Vec<Attribution>, command: &str) -> Vec<Block> {
        section::blocks(answer, command)
    }
}
