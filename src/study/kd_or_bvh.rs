//! `binary`: a binary KD-tree against a binary BVH, over the same triangle test.
//!
//! A leaf of the KD-tree tests eight triangles at once, one of the BVH one after the other.
//!
//! # References
//! Rivera-Alvarado, Zamora-Madrigal: An evaluation of Kd-Trees vs Bounding Volume Hierarchy (BVH) acceleration structures in
//! modern CPU architectures, 2023.

use serde::Serialize;

use super::args::{Measuring, QUICK_EPOCHS, Rays, Scenes, WORKLOADS, with_twin};
use super::compare::{compared, speed, twins};
use super::epoch::{Epoch, Settings};
use super::{Context, Data, Plan, SceneId, Study};
use crate::measure::Estimate;
use crate::registry::{Choice, ChoiceError, Registry};
use crate::report::number::{count, figures, plural};
use crate::report::words::{distinct, explained, interval, listed, scene_name};
use crate::report::{Cell, Record, Statement, Table};

const KD_TREE: &str = "sah-kd";
const BVH: &str = "obvhs-bvh2";

/// The KD-tree and the BVH on one scene.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Scenario {
    pub scene: String,
    pub scene_hash: String,
    pub stand_in: bool,
    pub triangles: usize,
    /// Time of the KD-tree's build over that of the BVH's.
    pub build: f64,
    /// Memory of the KD-tree over that of the BVH.
    pub bytes: f64,
    pub kinds: Vec<KindSpeed>,
}

/// One kind of rays.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct KindSpeed {
    pub workload: String,
    /// How many times as fast the KD-tree is; nothing where one of them has no time.
    pub speed: Option<Estimate>,
}

pub struct KdOrBvhStudy;

#[derive(Clone, Debug, clap::Args)]
pub struct KdOrBvhArgs {
    #[command(flatten)]
    scenes: Scenes,
    /// The triangle test of both
    #[arg(long, short, value_name = "NAME", default_value = TEST)]
    test: String,
    #[command(flatten)]
    rays: Rays,
    #[command(flatten)]
    measuring: Measuring,
}

const TEST: &str = "moller-trumbore";

impl Study for KdOrBvhStudy {
    const NAME: &'static str = "binary";
    const QUESTION: &'static str = "Is a binary KD-tree faster than a binary BVH in every case?";
    const QUICK: &'static str = QUICK_EPOCHS;

    type Args = KdOrBvhArgs;
    type Case = Epoch;
    type Answer = Vec<Scenario>;

    fn plan(args: &KdOrBvhArgs, registry: &Registry) -> anyhow::Result<Plan<Epoch>> {
        let choose = |name: &str| registry.choose(&format!("{name}:test={}", args.test));
        let pair = [KD_TREE, BVH].into_iter().map(choose).collect::<Result<Vec<Choice>, ChoiceError>>()?;
        let settings = args.measuring.settings(registry, with_twin(pair), args.rays.asked(&WORKLOADS))?;
        let plan = Settings { detailed: true, ..settings }.plan(args.scenes.read(&[])?, args.measuring.epochs);
        Ok(Plan { inputs: args.scenes.files(), ..plan })
    }

    fn answer(cases: &[Epoch], context: &Context<Self>) -> Vec<Scenario> {
        scenarios(&compared(cases, context.provenance).records)
    }

    fn tables(answer: &Vec<Scenario>) -> Vec<Table> {
        if answer.is_empty() { vec![] } else { vec![table(answer)] }
    }

    fn legend(_: &Vec<Scenario>) -> Vec<String> {
        vec![format!(
            "How many times as fast the KD-tree, {KD_TREE}, is as the BVH, {BVH}, with the interval that holds the ratio of another run, \
             as little disturbed, in 95 % of cases; build, memory: the KD-tree's as a multiple of the BVH's."
        )]
    }

    fn data(answer: &Vec<Scenario>) -> Vec<Data> {
        vec![Data::new(Self::NAME, answer)]
    }

    fn statements(answer: &Vec<Scenario>) -> Vec<Statement> {
        statement(answer).into_iter().collect()
    }

    fn scenes(answer: &Vec<Scenario>) -> Vec<SceneId> {
        let id = |s: &Scenario| SceneId { name: s.scene.clone(), hash: Some(s.scene_hash.clone()) };
        answer.iter().map(id).collect()
    }
}

fn scenarios(records: &[Record]) -> Vec<Scenario> {
    let noise = twins(records);
    let of = |scene: &String| {
        let of_structure = |name| records.iter().filter(move |r| r.scene == *scene && r.structure == name);
        let (kd, bvh) = (of_structure(KD_TREE).next()?, of_structure(BVH).next()?);
        let kind = |own: &Record| {
            let rival = of_structure(BVH).find(|rival| rival.workload == own.workload);
            KindSpeed { workload: own.workload.clone(), speed: rival.and_then(|rival| speed([(own, rival)], &noise)) }
        };
        Some(Scenario {
            scene: kd.scene.clone(),
            scene_hash: kd.scene_hash.clone(),
            stand_in: kd.stand_in,
            triangles: kd.triangles,
            build: kd.build_ns as f64 / bvh.build_ns.max(1) as f64,
            bytes: kd.bytes as f64 / bvh.bytes.max(1) as f64,
            kinds: of_structure(KD_TREE).map(kind).collect(),
        })
    };
    distinct(records.iter().map(|r| &r.scene)).iter().filter_map(of).collect()
}

fn table(scenarios: &[Scenario]) -> Table {
    let workloads = distinct(scenarios.iter().flat_map(|s| &s.kinds).map(|kind| &kind.workload));
    let row = |s: &Scenario| {
        let ratio = |workload: &String| {
            let speed = s.kinds.iter().find(|kind| kind.workload == *workload).and_then(|kind| kind.speed);
            speed.map(interval).into()
        };
        let name = [scene_name(&s.scene, s.stand_in), count(s.triangles as u64)].map(Cell::from);
        let costs = [figures(s.build), figures(s.bytes)].map(Cell::from);
        name.into_iter().chain(workloads.iter().map(ratio)).chain(costs).collect()
    };
    let names = ["scene", "triangles"].map(String::from);
    let costs = ["build", "memory"].map(String::from);
    explained(Table {
        title: "Speed of the binary KD-tree as a multiple of the binary BVH's".into(),
        columns: names.into_iter().chain(workloads.clone()).chain(costs).collect(),
        rows: scenarios.iter().map(row).collect(),
        notes: vec![],
    })
}

/// In how many cases each is faster. The cases are judged together: each interval allows for the others.
fn statement(scenarios: &[Scenario]) -> Option<Statement> {
    let cases: Vec<(&str, &str, Estimate)> = scenarios
        .iter()
        .flat_map(|s| s.kinds.iter().filter_map(|kind| Some((s.scene.as_str(), kind.workload.as_str(), kind.speed?))))
        .collect();
    if cases.is_empty() || cases.iter().any(|(.., speed)| speed.interval.is_none()) {
        return None;
    }
    let judged = |is: fn(&Estimate) -> bool| -> Vec<String> {
        let found = cases.iter().filter(|(.., speed)| is(&speed.ratio_among(cases.len())));
        found.map(|(scene, workload, _)| format!("{scene} {workload}")).collect()
    };
    let (faster, slower) = (judged(|speed| speed.is_above(1.0)), judged(|speed| speed.is_below(1.0)));
    let verdict = match (faster.len(), slower.len()) {
        (n, 0) if n == cases.len() => "The claim that it is faster in every case holds here",
        (_, 0) => "The claim that it is faster in every case is not decided here",
        _ => "The claim that it is faster in every case does not hold here",
    };
    // Those that speak against the claim.
    let named = if slower.is_empty() { String::new() } else { format!(" ({})", listed(&slower)) };
    Some(Statement::new(
        "claim",
        format!(
            "{verdict}: of {} of scene and kind of rays the binary KD-tree is faster than the binary BVH in {}, slower in {}{named}, and the \
             rest cannot be told apart.",
            plural(cases.len(), "case"),
            faster.len(),
            slower.len()
        ),
    ))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::timed_example;

    fn record(structure: &str, workload: &str, ns: f64) -> Record {
        let samples_ns = [1.0, 1.001, 1.0, 1.001].map(|f| f * ns);
        let build_ns = if structure == BVH { 100 } else { 250 };
        Record { build_ns, ..timed_example(&format!("{structure}:test={TEST}"), workload, &samples_ns, 4) }
    }

    fn told(ns: [f64; 2]) -> String {
        let of = |workload: &str, ns: f64| [record(KD_TREE, workload, 1e6), record(BVH, workload, ns)];
        let records = [of("primary", ns[0]), of("shadow", ns[1])].concat();
        let scenarios = scenarios(&records);
        assert_eq!((scenarios.len(), scenarios[0].build, table(&scenarios).rows.len()), (1, 2.5, 1));
        statement(&scenarios).unwrap().sentence
    }

    #[test]
    fn the_claim_holds_only_where_the_kd_tree_is_faster_in_all_cases() {
        assert!(told([2e6, 3e6]).starts_with("The claim that it is faster in every case holds here: of 2 cases"));
        let mixed = told([2e6, 5e5]);
        assert!(
            mixed.contains("does not hold")
                && mixed.contains("faster than the binary BVH in 1, slower in 1 (Cube shadow)"),
            "{mixed}"
        );
        assert!(told([2e6, 1e6]).contains("is not decided here"));
    }

    #[test]
    fn without_an_interval_nothing_is_claimed() {
        let one = |structure: &str| Record { epochs: 1, ..record(structure, "primary", 1e6) };
        assert_eq!(statement(&scenarios(&[one(KD_TREE), one(BVH)])), None);
        assert_eq!(statement(&[]), None);
    }
}
