//! From records to speeds against the fastest obvhs.

use serde::Serialize;

use crate::measure::{AaNoise, Estimate, geometric_mean};
use crate::report::Record;
use crate::report::words::distinct;
use crate::study::compare::{speed, twins};
use crate::study::reference_structures::is_obvhs;

/// The build whose time is the unit.
const DEAREST: [&str; 2] = ["obvhs-bvh2", "very-slow"];

/// What the study says.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Partitions {
    pub rows: Vec<Row>,
    /// Means over all scenes, where there is more than one.
    pub overall: Vec<Overall>,
    pub records: Vec<Record>,
}

impl Partitions {
    /// What these records of one run say.
    pub fn of(records: Vec<Record>) -> Self {
        Self { rows: rows(&records), overall: overall(&records), records }
    }
}

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

/// One structure over all scenes.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Overall {
    /// As chosen.
    pub structure: String,
    /// Geometric mean of its build times as shares of those of `obvhs-bvh2` with its dearest preset.
    pub build: Option<f64>,
    /// Kinds of rays, with the geometric mean of the speeds over the scenes.
    pub kinds: Vec<(String, Option<Estimate>)>,
    /// Over all cells.
    pub all: Option<Estimate>,
}

/// Compares the records of one run over the structures of the study.
fn rows(records: &[Record]) -> Vec<Row> {
    let noise = twins(records);
    let row = |own: &[&Record]| {
        let first = own[0];
        Row {
            scene: first.scene.clone(),
            triangles: first.triangles,
            structure: first.label.clone(),
            build: build(first, records),
            bytes: first.bytes as f64 / first.triangles as f64,
            cells: own.iter().map(|record| cell(record, records, &noise)).collect(),
            all: mean(own, records, &noise),
        }
    };
    ours(records).chunk_by(|a, b| a.scene == b.scene && a.label == b.label).map(row).collect()
}

/// The same structures over all scenes, where there is more than one: those that take part in all of them.
fn overall(records: &[Record]) -> Vec<Overall> {
    let (noise, ours) = (twins(records), ours(records));
    let scenes = |own: &[&Record]| distinct(own.iter().map(|record| &record.scene)).len();
    let every = scenes(&ours);
    let of = |structure: String| {
        let own: Vec<&Record> = ours.iter().copied().filter(|record| record.label == structure).collect();
        if every < 2 || scenes(&own) < every {
            return None;
        }
        let builds = own.chunk_by(|a, b| a.scene == b.scene).map(|scene| build(scene[0], records));
        let builds: Option<Vec<f64>> = builds.collect();
        let of_kind = |workload: String| {
            let cells: Vec<&Record> = own.iter().copied().filter(|record| record.workload == workload).collect();
            let mean = mean(&cells, records, &noise);
            (workload, mean)
        };
        let kinds = distinct(own.iter().map(|record| &record.workload)).into_iter().map(of_kind).collect();
        let all = mean(&own, records, &noise);
        Some(Overall { structure, build: builds.and_then(|builds| geometric_mean(&builds)), kinds, all })
    };
    distinct(ours.iter().map(|record| &record.label)).into_iter().filter_map(of).collect()
}

fn ours(records: &[Record]) -> Vec<&Record> {
    records.iter().filter(|record| !is_obvhs(&record.structure)).collect()
}

/// The records of obvhs on the scene of `record`.
fn rivals<'a>(record: &Record, records: &'a [Record]) -> impl Iterator<Item = &'a Record> {
    records.iter().filter(move |rival| rival.scene == record.scene && is_obvhs(&rival.structure))
}

/// The fastest of them on the same rays.
fn fastest<'a>(record: &Record, records: &'a [Record]) -> Option<&'a Record> {
    let timed = rivals(record, records).filter(|b| b.workload == record.workload && b.trace_ns.is_some());
    timed.min_by(|a, b| pace(a).total_cmp(&pace(b)))
}

/// Build time as a share of that of the dearest.
fn build(record: &Record, records: &[Record]) -> Option<f64> {
    let is_dearest = |b: &&Record| [&b.structure, b.config["preset"].as_str().unwrap_or("")] == DEAREST;
    rivals(record, records).find(is_dearest).map(|dearest| record.build_ns as f64 / dearest.build_ns as f64)
}

fn cell(record: &Record, records: &[Record], noise: &AaNoise) -> KindSpeed {
    KindSpeed {
        workload: record.workload.clone(),
        speed: mean(&[record], records, noise),
        baseline: fastest(record, records).map(|best| best.label.clone()),
        steps: record.steps_per_ray,
        tests: record.tests_per_ray,
    }
}

/// The geometric mean of speeds, each against the fastest of obvhs there; nothing where one is missing.
fn mean(own: &[&Record], records: &[Record], noise: &AaNoise) -> Option<Estimate> {
    let pairs = own.iter().map(|&record| {
        record.trace_ns?;
        Some((record, fastest(record, records)?))
    });
    speed(pairs.collect::<Option<Vec<_>>>()?, noise)
}

fn pace(record: &Record) -> f64 {
    record.trace_ns.map_or(f64::INFINITY, |ns| ns / record.rays as f64)
}
