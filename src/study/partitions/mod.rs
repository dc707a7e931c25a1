//! `partitions`: the same node, leaf and walk over four ways to divide the triangles, against the best of obvhs.

mod section;
mod table;
#[cfg(test)]
mod tests;

use serde::Serialize;

use super::args::{Measuring, Rays, Scenes, WORKLOADS, with_twin};
use super::baselines::is_obvhs;
use super::compare::{compared, speed, twins};
use super::epoch::{Epoch, Settings, troubles};
use super::{Context, Data, Effort, Plan, SceneId, Study, Trouble};
use crate::measure::Estimate;
use crate::registry::{Choice, ChoiceError, Registry};
use crate::report::document::Block;
use crate::report::{Record, Table};

use table::LEGEND;
pub use table::tables;

/// Those whose speed is asked for: the binary tree, and the wide one over each partition.
const OURS: [&str; 5] = ["sah-kd", "sah-kd-wide", "sah-kd-tight", "sah-hybrid", "sah-bvh"];

/// The presets and layouts of which the fastest counts, cell by cell.
const PRESETS: [&str; 6] = ["fastest", "very-fast", "fast", "medium", "slow", "very-slow"];
const LAYOUTS: [&str; 2] = ["obvhs-bvh2", "obvhs-cwbvh"];

/// The build whose time is the unit.
const DEAREST: &str = "very-slow";

/// One structure on one scene.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Row {
    pub scene: String,
    pub triangles: usize,
    /// As chosen.
    pub structure: String,
    /// Build time as a share of that of `obvhs-bvh2` with its dearest preset.
    pub build: Option<f64>,
    /// Bytes of the finished structure per triangle.
    pub bytes: f64,
    pub cells: Vec<KindSpeed>,
    /// Geometric mean of the speeds over the cells; nothing where one is missing.
    pub all: Option<Estimate>,
}

/// One structure and one kind of rays.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct KindSpeed {
    pub workload: String,
    /// Speed as a multiple of that of the fastest obvhs on these rays. Nothing where either gives wrong answers.
    pub speed: Option<Estimate>,
    /// Label of that obvhs.
    pub baseline: Option<String>,
    /// Nodes and leaves entered for each ray.
    pub steps: Option<f64>,
    /// Triangles tested for each ray.
    pub tests: Option<f64>,
}

/// Ours over the triangle test `test`, the wide ones with what is in `keys` (`,key=value..`), and all of obvhs with its own test.
///
/// # Errors
/// If a structure is not registered or refuses the keys.
fn structures(registry: &Registry, test: &str, keys: &str) -> Result<Vec<Choice>, ChoiceError> {
    let ours = OURS.iter().map(|&name| {
        let keys = if name == OURS[0] { "" } else { keys };
        registry.choose(&format!("{name}:test={test}{keys}"))
    });
    let presets = LAYOUTS.iter().flat_map(|layout| PRESETS.map(|preset| format!("{layout}:preset={preset}")));
    ours.chain(presets.map(|spec| registry.choose(&spec))).collect()
}

/// Compares the records of one run over the structures of the study.
pub fn rows(records: &[Record]) -> Vec<Row> {
    let noise = twins(records);
    let mut rows: Vec<Row> = vec![];
    let mut pairs: Vec<Vec<Option<(&Record, &Record)>>> = vec![];
    for record in records.iter().filter(|r| !is_obvhs(&r.structure)) {
        let rivals = || records.iter().filter(|b| b.scene == record.scene && is_obvhs(&b.structure));
        let timed = rivals().filter(|b| b.workload == record.workload && b.trace_ns.is_some());
        let best = timed.min_by(|a, b| pace(a).total_cmp(&pace(b)));
        let pair = best.filter(|_| record.trace_ns.is_some()).map(|best| (record, best));
        let cell = KindSpeed {
            workload: record.workload.clone(),
            speed: pair.and_then(|pair| speed([pair], &noise)),
            baseline: best.map(|best| best.label.clone()),
            steps: record.steps_per_ray,
            tests: record.tests_per_ray,
        };
        let begun = rows.last().is_some_and(|row| row.scene == record.scene && row.structure == record.label);
        if !begun {
            let dearest = |b: &&Record| b.structure == LAYOUTS[0] && b.config["preset"] == DEAREST;
            rows.push(Row {
                scene: record.scene.clone(),
                triangles: record.triangles,
                structure: record.label.clone(),
                build: rivals().find(dearest).map(|b| record.build_ns as f64 / b.build_ns as f64),
                bytes: record.bytes as f64 / record.triangles as f64,
                cells: vec![],
                all: None,
            });
            pairs.push(vec![]);
        }
        rows.last_mut().expect("begun").cells.push(cell);
        pairs.last_mut().expect("begun").push(pair);
    }
    for (row, pairs) in rows.iter_mut().zip(pairs) {
        let pairs: Option<Vec<(&Record, &Record)>> = pairs.into_iter().collect();
        row.all = pairs.and_then(|pairs| speed(pairs, &noise));
    }
    rows
}

/// Nanoseconds a ray, the median of the samples.
fn pace(record: &Record) -> f64 {
    record.trace_ns.map_or(f64::INFINITY, |ns| ns / record.rays as f64)
}

/// What the study says.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Partitions {
    pub rows: Vec<Row>,
    pub records: Vec<Record>,
}

/// The study.
pub struct PartitionsStudy;

/// Its options.
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

    type Args = PartitionsArgs;
    type Case = Epoch;
    type Answer = Partitions;

    fn args(effort: Effort) -> PartitionsArgs {
        let scenes = if effort == Effort::Quick { Scenes::named(&["torus"]) } else { Scenes::default() };
        let (rays, measuring) = (Rays::of(effort), Measuring::of(effort));
        PartitionsArgs { scenes, test: TEST.into(), keys: String::new(), rays, measuring }
    }

    fn plan(args: &PartitionsArgs, registry: &Registry) -> anyhow::Result<Plan<Epoch>> {
        let keys = if args.keys.is_empty() { String::new() } else { format!(",{}", args.keys) };
        let structures = with_twin(structures(registry, &args.test, &keys)?);
        let scenes = args.scenes.read(&["dragon", "lucy", "sponza"])?;
        let settings = args.measuring.settings(registry, structures, args.rays.asked(&WORKLOADS))?;
        let plan = Settings { slowest: 4.0, detailed: true, ..settings }.plan(scenes, args.measuring.epochs);
        Ok(Plan { inputs: args.scenes.files(), ..plan })
    }

    fn answer(cases: &[Epoch], context: &Context<Self>) -> Partitions {
        let records = compared(cases, context.provenance).records;
        Partitions { rows: rows(&records), records }
    }

    fn tables(answer: &Partitions) -> Vec<Table> {
        tables(&answer.rows)
    }

    fn legend(_: &Partitions) -> Vec<String> {
        LEGEND.map(String::from).into()
    }

    fn troubles(cases: &[Epoch]) -> Vec<Trouble> {
        troubles(cases)
    }

    fn data(answer: &Partitions) -> Vec<Data> {
        vec![Data::new(Self::NAME, &answer.records)]
    }

    fn section(answer: &Partitions, command: &str) -> Vec<Block> {
        section::blocks(&answer.rows, command)
    }

    fn scenes(answer: &Partitions) -> Vec<SceneId> {
        answer.records.iter().map(SceneId::of).collect()
    }
}
