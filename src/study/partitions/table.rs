//! The rows as tables for people.

use super::Row;
use crate::measure::Estimate;
use crate::report::number::{count, figures};
use crate::report::words::{explained, written};
use crate::report::{Cell, Table, Tone};

/// One table for each scene: speeds, then what explains them.
pub fn tables(rows: &[Row]) -> Vec<Table> {
    let mut scenes: Vec<&str> = rows.iter().map(|row| row.scene.as_str()).collect();
    scenes.dedup();
    scenes.into_iter().map(|scene| table(rows.iter().filter(|row| row.scene == scene).collect())).collect()
}

fn table(rows: Vec<&Row>) -> Table {
    let first = rows[0];
    let mut columns: Vec<String> = vec!["structure".into(), "build x".into(), "B/triangle".into()];
    columns.extend(first.cells.iter().map(|cell| cell.workload.clone()));
    columns.push("all".into());
    columns.extend(first.cells.iter().map(|cell| format!("{} steps+tests", cell.workload)));
    let best = rows.iter().filter_map(|row| row.all).map(|all| all.estimate).fold(0.0, f64::max);
    let known = |x: Option<f64>| x.map_or(String::new(), figures);
    let cells = rows.iter().map(|row| {
        let mut cells: Vec<Cell> =
            vec![row.structure.as_str().into(), known(row.build).into(), figures(row.bytes).into()];
        cells.extend(row.cells.iter().map(|cell| Cell::from(interval(cell.speed))));
        let tone = if row.all.is_some_and(|all| all.estimate == best) { Tone::Best } else { Tone::Plain };
        cells.push(Cell::from(interval(row.all)).with(tone));
        cells.extend(row.cells.iter().map(|c| Cell::from(format!("{}+{}", known(c.steps), known(c.tests)))));
        cells
    });
    let baselines = first.cells.iter().filter_map(|c| Some(format!("{}: {}", c.workload, c.baseline.as_deref()?)));
    explained(Table {
        title: format!("{}: {} triangles", first.scene, count(first.triangles as u64)),
        columns,
        rows: cells.collect(),
        notes: vec![format!("Fastest of obvhs: {}.", baselines.collect::<Vec<_>>().join("; "))],
    })
}

fn interval(x: Option<Estimate>) -> String {
    x.map_or(String::new(), |x| written(x, |x| format!("{x:.2}")))
}

/// What the columns mean.
pub const LEGEND: [&str; 2] = [
    "Speed as a multiple of the fastest obvhs on the same rays, over all its presets and both layouts, cell by cell: medians of \
     paired ratios, with the interval that holds the ratio of another run in 95 % of cases; all: geometric mean.",
    "build x: build time over that of obvhs-bvh2 with preset very-slow. steps: nodes and leaves entered, tests: triangles \
     tested, for each ray.",
];
