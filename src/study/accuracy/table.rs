use super::{AccuracyRecord, RayKind};
use crate::report::number::{count, figures};
use crate::report::{Cell, Table, Tone};

/// One table for each kind of rays of a scene.
pub fn tables(records: &[AccuracyRecord], notes: &[String]) -> Vec<Table> {
    let tables = records.chunk_by(|a, b| a.rays == b.rays && a.scene == b.scene).map(table);
    let mut tables: Vec<Table> = tables.collect();
    if let Some(last) = tables.last_mut() {
        last.notes.extend_from_slice(notes);
    }
    tables
}

const COLUMNS: [&str; 13] = [
    "structure",
    "ns/ray",
    "slowest",
    "error",
    "at most",
    "missed",
    "false",
    "depth",
    "primitive",
    "ulps: median",
    "99 %",
    "max",
    "dominated by",
];

fn table(records: &[AccuracyRecord]) -> Table {
    let first = &records[0];
    let stand_in = if first.stand_in { ", stand-in" } else { "" };
    let what = first.rays.parse().map_or("rays of a file", RayKind::description);
    let rays = records.iter().map(|record| record.judged).max().unwrap_or(0);
    let title = format!(
        "{}: {} triangles{stand_in}; {}: {} {what}, {} hit",
        first.scene,
        count(first.triangles as u64),
        first.rays,
        count(rays),
        count(records.iter().map(|record| record.hits).max().unwrap_or(0)),
    );
    let rows = records.iter().map(row).collect();
    let mut notes = vec![];
    for record in records.iter().filter(|record| record.sampled) {
        notes.push(format!("{}: judged on {} of the rays", record.label, count(record.judged)));
    }
    let timed = records.iter().map(|record| record.timed).max().unwrap_or(0);
    for record in records.iter().filter(|record| record.timed < timed) {
        let [own, others] = [record.timed, timed].map(|n| count(n as u64));
        notes.push(format!("{}: timed on {own} of the {others} rays that the others are timed on", record.label));
    }
    Table { title, columns: COLUMNS.map(String::from).into(), rows, notes }
}

fn row(record: &AccuracyRecord) -> Vec<Cell> {
    let errors = |n: u64| Cell::from(count(n)).with(if n > 0 { Tone::Wrong } else { Tone::Plain });
    let ulps = |value: fn(&crate::validate::Ulps) -> f64| record.ulps.as_ref().map(|u| figures(value(u))).into();
    let tone = if record.dominated_by.is_none() { Tone::Best } else { Tone::Plain };
    vec![
        record.label.as_str().into(),
        Cell::from(figures(record.ns_per_ray)).with(tone),
        record.slowest_ns.map(|ns| figures(ns as f64)).into(),
        Cell::from(percent(record.error)).with(tone),
        percent(record.error_bound).into(),
        errors(record.missed),
        errors(record.false_hits),
        errors(record.wrong_depth),
        count(record.wrong_primitive).into(),
        ulps(|u| u.median),
        ulps(|u| u.p99),
        ulps(|u| u.max),
        record.dominated_by.as_deref().unwrap_or("").into(),
    ]
}

/// A share as people read it.
pub fn percent(share: f64) -> String {
    if share == 0.0 { "0".into() } else { format!("{} %", figures(share * 100.0)) }
}

/// What the columns mean.
pub fn legend() -> Vec<String> {
    [
        "slowest: nanoseconds that the slowest of the rays takes when it is asked alone, with what asking takes.",
        "error: share of rays with a wrong answer by exact arithmetic: missed, false hits, or a depth that is off by more than 4 \
         units in the last place and more than 1e-6; at most: its upper bound with 95 % confidence by Clopper \
         and Pearson (no error in n rays: about 3/n).",
        "primitive: hits at a triangle that is not the nearest, by whatever little; not part of the error. ulps: error of t where \
         the triangle is right; at most 0.5 is correctly rounded.",
        "dominated by: at most as slow and at most as wrong, and better in one of the two; blank on the front. Kinds of rays are \
         never added up.",
    ]
    .map(String::from)
    .into()
}
