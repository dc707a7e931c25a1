//! From records to speeds against the fastest obvhs.

use serde::Serialize;

use crate::measure::Estimate;
use crate::report::Record;
use crate::study::compare::{speed, twins};
use crate::study::reference_structures::is_obvhs;

/// The build whose time is the unit.
const DEAREST: [&str; 2] = ["obvhs-bvh2", "very-slow"];

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
            let dearest = |b: &&Record| [&b.structure, b.config["preset"].as_str().unwrap_or("")] == DEAREST;
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

fn pace(record: &Record) -> f64 {
    record.trace_ns.map_or(f64::INFINITY, |ns| ns / record.rays as f64)
}
