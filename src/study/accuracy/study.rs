//! `accuracy` as a study.

use anyhow::Context as _;
use serde::{Deserialize, Serialize};
use serde_json::json;

use super::{AccuracyRecord, AccuracySettings, RayKind, accuracy_scene, figure, legend, section, table};
use crate::measure::Threads;
use crate::registry::{Choice, Registry};
use crate::report::document::Block;
use crate::report::number::count;
use crate::report::plot::Figure;
use crate::report::words::each_once_by;
use crate::report::{Statement, Table};
use crate::scene::Scene;
use crate::study::args::{Scenes, kinds};
use crate::study::plan::{Measure, named_notes, scene_key};
use crate::study::{
    BRUTE_FORCE, Context, Data, Plan, RaySource, Refused, SceneId, Seconds, Study, Trouble, documented_defect,
    replayed, sources,
};
use crate::triangle::{Exact, TriangleTest};

pub struct AccuracyStudy;

#[derive(Clone, Debug, clap::Args)]
pub struct AccuracyArgs {
    #[command(flatten)]
    scenes: Scenes,
    /// A structure, over every triangle test unless it names one; may be repeated [default: all; brute-force only on
    /// meshes of at most 5,000 triangles]
    #[arg(long, short, value_name = "NAME[:key=value,..]")]
    structure: Vec<String>,
    /// A triangle test; may be repeated [default: all]
    #[arg(long, short, value_name = "NAME")]
    test: Vec<String>,
    /// A kind of rays: uniform, edge, vertex, axis, grazing, scale, offset or surface; may be repeated [default: all]
    #[arg(long, short, value_name = "KIND")]
    workload: Vec<RayKind>,
    /// Rays of each kind: without an error among n, the error is below about 3/n with 95 % confidence; or a file of rays to
    /// replay, in place of kinds
    #[arg(long, value_name = "N|F.rays", default_value = "20000")]
    rays: RaySource,
    /// Samples of every case
    #[arg(long, value_name = "N", default_value_t = RUNS, value_parser = clap::value_parser!(u16).range(1..))]
    runs: u16,
    /// Seconds that the samples of a scene may take: slow cases are timed on fewer rays to keep within them
    #[arg(long, value_name = "SECONDS", default_value_t = BUDGET, allow_negative_numbers = true)]
    budget: Seconds,
    /// Seed of the rays and of the order of samples
    #[arg(long, value_name = "N", default_value_t = 1)]
    seed: u64,
}

const RUNS: u16 = 7;
const BUDGET: Seconds = Seconds::whole(40);

/// Brute force takes part in meshes up to this size, unless it is asked for.
const SMALL: usize = 5000;

/// What came of one scene.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct JudgedScene {
    records: Vec<AccuracyRecord>,
    refused: Vec<Refused>,
    /// What is to be said about structures that take no part.
    note: Option<String>,
}

impl Study for AccuracyStudy {
    const NAME: &'static str = "accuracy";
    const QUESTION: &'static str =
        "What does being right cost: how wrong and how fast is every structure over every triangle test?";
    const SCENE_BY_SCENE: bool = true;
    const PLOT: Option<fn(&Self::Answer) -> Figure> = Some(|answer| figure(answer));
    const FULL: &'static str = "dragon cornellbox -w uniform -w vertex -w grazing";
    const QUICK: &'static str = "cube -w vertex --rays 500 --runs 2 --budget 1";

    type Args = AccuracyArgs;
    type Case = JudgedScene;
    type Answer = Vec<AccuracyRecord>;

    fn plan(args: &AccuracyArgs, registry: &Registry) -> anyhow::Result<Plan<JudgedScene>> {
        let choices = choices(registry, &args.structure, &args.test)?;
        let (scenes, replayed) = match replayed(&args.rays, &args.scenes.scenes)? {
            Some((scene, file)) => {
                anyhow::ensure!(args.workload.is_empty(), "the rays are those of the file: leave --workload out");
                (vec![scene], Some(file.workload))
            }
            None => (args.scenes.read(&[])?, None),
        };
        let kinds = kinds(&args.workload, &RayKind::ALL);
        let labels: Vec<&str> = choices.iter().map(|choice| choice.label.as_str()).collect();
        let names: Vec<&str> = kinds.iter().map(|kind| kind.name()).collect();
        let rays = args.rays.number()?;
        let kept = json!({
            "structures": labels.join(" "),
            "workloads": replayed.as_ref().map_or(names.join(" "), |rays| format!("replayed {}", rays.hash())),
            "rays": rays,
            "runs": args.runs,
            "budget": args.budget,
            "seed": args.seed,
        });
        let titles: Vec<(String, String)> = scenes.iter().map(|scene| (scene.name.clone(), scene_key(scene))).collect();
        let notes = named_notes(&scenes, |scene| &scene.notes);
        let inputs = args.scenes.files().into_iter().chain(args.rays.file().map(Into::into)).collect();
        let threads = Threads::pinned(1).map_err(anyhow::Error::msg)?;
        let (is_default, runs, seed) = (args.structure.is_empty(), args.runs.into(), args.seed);
        let budget_ns = args.budget.ns();
        let measure: Measure<JudgedScene> = Box::new(move |case, clock, progress| {
            let scene = &scenes[case.scene];
            let (choices, note) = fitting(&choices, scene, is_default);
            let (kinds, replayed) = (kinds.clone(), replayed.clone());
            let settings = AccuracySettings { choices, kinds, replayed, rays, runs, budget_ns, seed };
            let (records, refused) = accuracy_scene(scene, &settings, clock, progress)?;
            Ok(JudgedScene { records, refused, note })
        });
        Ok(Plan { notes, inputs, ..Plan::of_scenes(&kept, threads, titles, measure) })
    }

    fn answer(cases: &[JudgedScene], context: &Context<Self>) -> Vec<AccuracyRecord> {
        let provenance = Some(context.provenance.clone());
        let of_run = |record: &AccuracyRecord| AccuracyRecord { provenance: provenance.clone(), ..record.clone() };
        cases.iter().flat_map(|case| &case.records).map(of_run).collect()
    }

    fn tables(answer: &Vec<AccuracyRecord>) -> Vec<Table> {
        answer.chunk_by(AccuracyRecord::is_beside).map(table).collect()
    }

    fn legend(_: &Vec<AccuracyRecord>) -> Vec<String> {
        legend()
    }

    fn troubles(cases: &[JudgedScene]) -> Vec<Trouble> {
        // Only one test promises the truth, and only in a structure that loses nothing.
        let owed = |r: &AccuracyRecord| r.triangle_test == Exact::NAME && documented_defect(&r.structure).is_none();
        let none = Trouble { structure: String::new(), sentence: String::new(), refused: false, wrong: false };
        let mut troubles: Vec<Trouble> = vec![];
        for case in cases {
            let broken = case.records.iter().filter(|r| owed(r) && r.errors() + r.wrong_primitive > 0);
            troubles.extend(broken.map(|r| Trouble { structure: r.structure.clone(), wrong: true, ..none.clone() }));
            troubles.extend(case.refused.iter().map(|refused| Trouble {
                sentence: format!("{} on {} is refused: {}.", refused.label, refused.scene, refused.reason),
                ..refused.trouble()
            }));
            troubles.extend(case.note.iter().map(|note| Trouble { sentence: format!("{note}."), ..none.clone() }));
        }
        troubles.dedup();
        troubles
    }

    fn data(answer: &Vec<AccuracyRecord>) -> Vec<Data> {
        vec![Data::new(Self::NAME, answer)]
    }

    fn statements(answer: &Vec<AccuracyRecord>) -> Vec<Statement> {
        section::statements(answer)
    }

    fn section(answer: &Vec<AccuracyRecord>, command: &str) -> Vec<Block> {
        section::blocks(answer, command)
    }

    fn scenes(answer: &Vec<AccuracyRecord>) -> Vec<SceneId> {
        answer.iter().map(|r| SceneId { name: r.scene.clone(), hash: Some(r.scene_hash.clone()) }).collect()
    }
}

/// Every structure over every triangle test that it is offered with and that is asked for.
fn choices(registry: &Registry, structures: &[String], tests: &[String]) -> anyhow::Result<Vec<Choice>> {
    sources::known_tests(registry, tests)?;
    let mut choices: Vec<Choice> = vec![];
    for spec in sources::specs(registry, structures) {
        let choice = sources::structure(registry, &spec)?;
        let keys = spec.split_once(':').map_or("", |(_, keys)| keys);
        let names_test = keys.split(',').any(|key| key.starts_with("test="));
        for entry in registry.entries().iter().filter(|entry| entry.name == choice.entry.name) {
            let asked = if names_test { entry.triangle_test == choice.triangle_test() } else { true };
            if !asked || !tests.is_empty() && !tests.iter().any(|test| test.eq_ignore_ascii_case(entry.triangle_test)) {
                continue;
            }
            let with_test = match (names_test, keys) {
                (true, _) => spec.clone(),
                (false, "") => format!("{}:test={}", entry.name, entry.triangle_test),
                (false, keys) => format!("{}:{keys},test={}", entry.name, entry.triangle_test),
            };
            choices.push(sources::structure(registry, &with_test)?);
        }
    }
    let choices = each_once_by(choices, |one, other| one.label == other.label);
    choices
        .first()
        .context("none of the structures is offered over the triangle tests asked for: see `sahara list`")?;
    Ok(choices)
}

/// The choices that take part in `scene`, and what is to be said about those that do not.
fn fitting(choices: &[Choice], scene: &Scene, is_default: bool) -> (Vec<Choice>, Option<String>) {
    let mut fitting = choices.to_vec();
    if !is_default || scene.mesh.len() <= SMALL {
        return (fitting, None);
    }
    fitting.retain(|choice| choice.entry.name != BRUTE_FORCE);
    let left_out = fitting.len() < choices.len();
    let note = format!(
        "brute-force is left out of meshes with more than {} triangles: --structure brute-force runs it, on a part of the rays",
        count(SMALL as u64)
    );
    (fitting, left_out.then_some(note))
}
