use super::{AccuracyRecord, RayKind};
use crate::report::number::{count, figures};
use crate::report::{Cell, Table, Tone};
use crate::validate::Ulps;

/// That of one scene and kind of rays.
pub fn table(records: &[AccuracyRecord]) -> Table {
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
    let mut notes = vec![];
    for record in records.iter().filter(|record| record.sampled) {
        notes.push(format!("{}: judged on {} of the rays", record.label, count(record.judged)));
    }
    let timed = records.iter().map(|record| record.timed).max().unwrap_or(0);
    for record in records.iter().filter(|record| record.timed < timed) {
        let [own, others] = [record.timed, timed].map(|n| count(n as u64));
        notes.push(format!("{}: timed on {own} of the {others} rays that the others are timed on", record.label));
    }
    Table { notes, ..cells(title, records) }
}

fn cells(title: String, records: &[AccuracyRecord]) -> Table {
    let tone = |r: &AccuracyRecord| if r.dominated_by.is_none() { Tone::Best } else { Tone::Plain };
    let errors = |n: u64| Cell::from(count(n)).with(if n > 0 { Tone::Wrong } else { Tone::Plain });
    let ulps =
        |r: &AccuracyRecord, value: fn(&Ulps) -> f64| Cell::from(r.ulps.as_ref().map(|ulps| figures(value(ulps))));
    Table::of(
        title,
        records,
        &[
            ("structure", &|r| r.label.as_str().into()),
            ("ns/ray", &|r| Cell::from(figures(r.ns_per_ray)).with(tone(r))),
            ("slowest", &|r| r.slowest_ns.map(|ns| figures(ns as f64)).into()),
            ("error", &|r| Cell::from(percent(r.error)).with(tone(r))),
            ("at most", &|r| percent(r.error_bound).into()),
            ("missed", &|r| errors(r.missed)),
            ("false", &|r| errors(r.false_hits)),
            ("depth", &|r| errors(r.wrong_depth)),
            ("primitive", &|r| count(r.wrong_primitive).into()),
            ("ulps: median", &|r| ulps(r, |ulps| ulps.median)),
            ("99 %", &|r| ulps(r, |ulps| ulps.p99)),
            ("max", &|r| ulps(r, |ulps| ulps.max)),
            ("dominated by", &|r| r.dominated_by.as_deref().into()),
        ],
    )
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
