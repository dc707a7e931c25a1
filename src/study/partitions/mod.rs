//! `partitions`: the same node, leaf and walk over four ways to divide the triangles, against the best of obvhs.

mod rows;
mod section;
mod table;
#[cfg(test)]
mod tests;

use super::args::{Measuring, QUICK_EPOCHS, Rays, SLOWEST, Scenes, WORKLOADS, with_twin};
use super::compare::compared;
use super::epoch::{Epoch, Settings};
use super::{Context, Data, Plan, SceneId, Study};
use crate::registry::{Choice, ChoiceError, Registry};
use crate::report::document::Block;
use crate::report::{Statement, Table};

pub use rows::{KindSpeed, Overall, Partitions, Row};
use table::LEGEND;
pub use table::{all_scenes, tables};

/// Those whose speed is asked for: the binary tree, and the wide one over each partition.
const OURS: [&str; 5] = ["sah-kd", "sah-kd-wide", "sah-kd-tight", "sah-hybrid", "sah-bvh"];

/// The presets and layouts of which the fastest counts, cell by cell.
const PRESETS: [&str; 6] = ["fastest", "very-fast", "fast", "medium", "slow", "very-slow"];
const LAYOUTS: [&str; 2] = ["obvhs-bvh2", "obvhs-cwbvh"];

/// Ours over the triangle test `test`, the wide ones with what is in `keys` (`,key=value..`), and all of obvhs with its own test.
fn structures(registry: &Registry, test: &str, keys: &str) -> Result<Vec<Choice>, ChoiceError> {
    let ours = OURS.iter().map(|&name| {
        let keys = if name == OURS[0] { "" } else { keys };
        registry.choose(&format!("{name}:test={test}{keys}"))
    });
    let presets = LAYOUTS.iter().flat_map(|layout| PRESETS.map(|preset| format!("{layout}:preset={preset}")));
    ours.chain(presets.map(|spec| registry.choose(&spec))).collect()
}

pub struct PartitionsStudy;

#[derive(Clone, Debug, clap::Args)]
pub struct PartitionsArgs {
    #[command(flatten)]
    scenes: Scenes,
    /// The triangle test of ours; obvhs has its own, which is Möller and Trumbore's in f32 as well
    #[arg(long, short, value_name = "NAME", default_value = TEST)]
    test: String,
    /// Keys of the wide trees that differ from their defaults, as in batch=packets,quality=high
    #[arg(long, value_name = "key=value,..", default_value = "")]
    keys: String,
    #[command(flatten)]
    rays: Rays,
    #[command(flatten)]
    measuring: Measuring<3, 5, 40>,
}

const TEST: &str = "moller-trumbore";

impl Study for PartitionsStudy {
    const NAME: &'static str = "partitions";
    const QUESTION: &'static str =
        "Which way to divide the triangles is the fastest, for the same node, leaf and traversal?";
    const QUICK: &'static str = QUICK_EPOCHS;

    type Args = PartitionsArgs;
    type Case = Epoch;
    type Answer = Partitions;

    fn plan(args: &PartitionsArgs, registry: &Registry) -> anyhow::Result<Plan<Epoch>> {
        let keys = if args.keys.is_empty() { String::new() } else { format!(",{}", args.keys) };
        let structures = with_twin(structures(registry, &args.test, &keys)?);
        let scenes = args.scenes.read(&["dragon", "lucy", "sponza"])?;
        let settings = args.measuring.settings(registry, structures, args.rays.asked(&WORKLOADS))?;
        let plan = Settings { slowest: SLOWEST, detailed: true, ..settings }.plan(scenes, args.measuring.epochs);
        Ok(Plan { inputs: args.scenes.files(), ..plan })
    }

    fn answer(cases: &[Epoch], context: &Context<Self>) -> Partitions {
        Partitions::of(compared(cases, context.provenance).records)
    }

    fn tables(answer: &Partitions) -> Vec<Table> {
        tables(answer)
    }

    fn legend(_: &Partitions) -> Vec<String> {
        LEGEND.map(String::from).into()
    }

    fn data(answer: &Partitions) -> Vec<Data> {
        vec![Data::new(Self::NAME, &answer.records)]
    }

    fn statements(answer: &Partitions) -> Vec<Statement> {
        section::statements(&answer.rows)
    }

    fn section(answer: &Partitions, command: &str) -> Vec<Block> {
        section::blocks(answer, command)
    }

    fn scenes(answer: &Partitions) -> Vec<SceneId> {
        answer.records.iter().map(SceneId::of).collect()
    }
}
