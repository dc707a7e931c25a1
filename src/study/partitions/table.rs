//! The rows as tables for people.

use super::rows::{Overall, Partitions, Row};
use crate::measure::Estimate;
use crate::report::number::{count, figures};
use crate::report::words::{bare, distinct, explained, written};
use crate::report::{Cell, Table, Tone};

/// One table for each scene: speeds, then what explains them; and one for all of them.
pub fn tables(answer: &Partitions) -> Vec<Table> {
    let of_scenes = answer.rows.chunk_by(|a, b| a.scene == b.scene).map(table);
    of_scenes.chain(all_scenes(answer)).collect()
}

/// The means over all scenes, where there are several.
pub fn all_scenes(answer: &Partitions) -> Option<Table> {
    let first = answer.overall.first()?;
    let mut columns: Vec<String> = vec!["structure".into(), "build x".into()];
    columns.extend(first.kinds.iter().map(|(workload, _)| workload.clone()));
    columns.push("all".into());
    let best = highest(answer.overall.iter().map(|overall| overall.all));
    let cells = |Overall { structure, build, kinds, all }: &Overall| {
        let mut cells: Vec<Cell> = vec![bare(structure).into(), known(*build).into()];
        cells.extend(kinds.iter().map(|(_, speed)| Cell::from(interval(*speed))));
        cells.push(mean(*all, best));
        cells
    };
    let scenes = distinct(answer.rows.iter().map(|row| &row.scene)).len();
    Some(explained(Table {
        title: format!("All {scenes} scenes: geometric means"),
        columns,
        rows: answer.overall.iter().map(cells).collect(),
        notes: vec![],
    }))
}

/// That of one scene.
pub fn table(rows: &[Row]) -> Table {
    let first = &rows[0];
    let mut columns: Vec<String> = vec!["structure".into(), "build x".into(), "B/triangle".into()];
    columns.extend(first.cells.iter().map(|cell| cell.workload.clone()));
    columns.push("all".into());
    columns.extend(first.cells.iter().map(|cell| format!("{} steps+tests", cell.workload)));
    let best = highest(rows.iter().map(|row| row.all));
    let cells = rows.iter().map(|row| {
        let mut cells: Vec<Cell> =
            vec![row.structure.as_str().into(), known(row.build).into(), figures(row.bytes).into()];
        cells.extend(row.cells.iter().map(|cell| Cell::from(interval(cell.speed))));
        cells.push(mean(row.all, best));
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

fn highest(speeds: impl Iterator<Item = Option<Estimate>>) -> f64 {
    speeds.flatten().map(|speed| speed.estimate).fold(0.0, f64::max)
}

/// A mean, marked where it is the best of its column.
fn mean(all: Option<Estimate>, best: f64) -> Cell {
    let tone = if all.is_some_and(|all| all.estimate == best) { Tone::Best } else { Tone::Plain };
    Cell::from(interval(all)).with(tone)
}

fn known(x: Option<f64>) -> String {
    x.map_or(String::new(), figures)
}

fn interval(x: Option<Estimate>) -> String {
    x.map_or(String::new(), |x| written(x, |x| format!("{x:.2}")))
}

/// What the columns mean.
pub const LEGEND: [&str; 2] = [
    "Speed as a multiple of the fastest obvhs on the same rays, over all its presets and both layouts, cell by cell: medians of \
     paired ratios, with the interval that holds the ratio of another run, as little disturbed, in 95 % of cases; all: geometric mean.",
    "build x: build time over that of obvhs-bvh2 with preset very-slow. steps: nodes and leaves entered, tests: triangles \
     tested, for each ray.",
];
