//! One scene as a table for people.

use super::details::details;
use super::reference::{Reference, cell};
use crate::accel::Query;
use crate::report::number::{count, figures, plural};
use crate::report::words::{distinct, listed};
use crate::report::{Cell, Table, Tone, Value};
use crate::request::{is_large, known_defect};
use crate::study::measurement::{Measurement, UntimedStructure, trace_noise};
use crate::triangle::{Exact, TriangleTest};

/// What a structure is asked with that answers many rays in one call.
const PACKETS: &str = "batch=packets";

/// Said where brute force could check few rays, since there are so many triangles.
fn few_checked(all: &[Measurement]) -> Option<String> {
    let triangles = all.first()?.triangles;
    let least = all.iter().filter(|r| r.declined.is_none()).map(|r| r.checked_rays).min()?;
    is_large(triangles).then(|| {
        format!(
            "Answers were checked on {} rays of a kind, evenly spread: against so many triangles brute force would take minutes for more.",
            count(least as u64)
        )
    })
}

/// What the other columns of the tables of these all mean, once for all tables.
pub fn legend(all: &[Measurement], references: &[Reference]) -> Vec<String> {
    let columns: Vec<String> = references.iter().map(|reference| format!("x {}", reference.name())).collect();
    let against: Vec<String> = references.iter().map(|reference| format!("against {}", reference.words())).collect();
    let (columns, against) = (columns.join(", "), listed(&against));
    let mut speeds = "Under each kind of rays: million rays a second, median".to_owned();
    if all.iter().any(Measurement::is_disqualified) {
        speeds += "; n/m wrong: wrong answers to n of m rays, and then no time";
    }
    if all.iter().any(|r| r.mrays_per_s.is_some() && r.sampled) {
        speeds += "; ~: timed on a subset of the rays";
    }
    if all.iter().any(|r| r.query == Query::Any) {
        speeds += "; *: timed by any hit, the others by closest hit";
    }
    let intervals = match all.iter().any(|r| r.epochs > 1) {
        true => {
            ", with the interval that holds the ratio of another run, as little disturbed, in 95 % of cases; =: not distinguishable from 1"
        }
        false => "",
    };
    let mut legend = vec![
        speeds + ".",
        format!("{columns}: speed {against}, geometric mean over the row on the same rays{intervals}."),
    ];
    let has = |part: &str| all.iter().any(|r| r.label.contains(part));
    if has(PACKETS) {
        let obvhs = if has("obvhs") { "; obvhs has no such call, and answers ray by ray" } else { "" };
        legend.push(format!("{PACKETS}: asked for many rays in one call{obvhs}."));
    }
    legend
}

/// Why structures are refused, each reason once for all tables.
pub fn refusals(refused: &[UntimedStructure]) -> Vec<String> {
    let reason = |reason: &String| {
        let of = refused.iter().filter(|r| r.reason == *reason).map(|r| &r.label);
        format!("Refused: {}: {reason}.", listed(&distinct(of)))
    };
    distinct(refused.iter().map(|r| &r.reason)).iter().map(reason).collect()
}

/// One scene, one row for each structure, those that are refused last, with a column of ratios for each of the
/// `references`; with all columns where it is `wide`.
pub fn scene_table(all: &[Measurement], references: &[Reference], refused: &[UntimedStructure], wide: bool) -> Table {
    let Some(first) = all.first() else { return Table::default() };
    let workloads = distinct(all.iter().map(|r| &r.workload));
    let structures = distinct(all.iter().map(|r| &r.label));
    let of = |label: &str| -> Vec<&Measurement> { all.iter().filter(|r| r.label == label).collect() };
    let noise = trace_noise(all);
    let best_of = |workload: &String| {
        let speeds = all.iter().filter(|r| r.workload == *workload).filter_map(|r| r.mrays_per_s);
        speeds.max_by(f64::total_cmp).unwrap_or(f64::INFINITY)
    };
    let best: Vec<f64> = workloads.iter().map(best_of).collect();

    let mut columns = vec!["structure".to_owned()];
    for workload in &workloads {
        let any = all.iter().any(|r| r.workload == *workload && r.query == Query::Any);
        columns.push(format!("{workload}{}", if any { "*" } else { "" }));
    }
    columns.extend(references.iter().map(|reference| format!("x {}", reference.name())));
    let row = |label: &String| {
        let of = of(label);
        let mut row = vec![Cell::from(label)];
        for (workload, best) in workloads.iter().zip(&best) {
            row.push(of.iter().find(|r| r.workload == *workload).map_or(Cell::empty(), |r| speed(r, *best)));
        }
        // A row that lacks a time, other than one that it declines, has no mean.
        let timed: Vec<&Measurement> = of.iter().copied().filter(|r| r.declined.is_none()).collect();
        row.extend(references.iter().map(|reference| {
            let pairs = reference.pairs(all, timed.iter().copied());
            let whole = pairs.len() == timed.len();
            let mean = cell(if whole { Reference::ratio(&pairs, &noise) } else { None });
            let is_part = timed.len() < of.len() && !mean.is_empty();
            if is_part { mean.noted(format!("{} of {}", timed.len(), of.len())) } else { mean }
        }));
        row
    };
    let mut rows: Vec<Vec<Cell>> = structures.iter().map(row).collect();
    let width = columns.len();
    rows.extend(refused.iter().map(|refused| {
        let mut row = vec![Cell::empty(); width];
        row[0] = Cell::from(&refused.label);
        row[1] = Cell::from("refused").with(Tone::Wrong);
        row
    }));
    if wide {
        details(all, &workloads, &mut columns, &mut rows);
    }

    let degenerate = match first.degenerate {
        0 => String::new(),
        n => format!(" ({} degenerate)", count(n as u64)),
    };
    let stand_in = if first.stand_in { ", stand-in" } else { "" };
    let title = format!("{}: {}{degenerate}{stand_in}", first.scene, plural(first.triangles, "triangle"));
    let mut notes = vec![];
    for own in all {
        let Some(what) = &own.declined else { continue };
        notes.push(format!("{} declines {what}, which {} rays need.", own.label, own.workload));
    }
    notes.extend(defects(all));
    notes.extend(unfit_tests(all));
    notes.extend(few_checked(all));
    notes.extend(control(all));
    Table::new(title, columns, rows).noted(notes).without_empty_columns().of_one_scene().explained()
}

/// A footnote about the A/A ratios, where there are any.
pub(super) fn control(all: &[Measurement]) -> Option<String> {
    let (twins, label) = (trace_noise(all), &all.iter().find(|r| r.twin_samples_ns.is_some())?.label);
    let noise = libm::exp(twins.log()?) - 1.0;
    let holding = twins.holding_one();
    let holding = holding.map_or(String::new(), |(n, all)| format!("; {n} of {all} ratios hold 1 in their intervals"));
    // What the epochs scatter by may hide it: that is no proof of none.
    let noise = match noise {
        0.0 => "not seen above the scatter of the epochs".into(),
        _ => format!("{}%", figures(noise * 100.0)),
    };
    Some(format!("A/A noise ({label} twice): {noise}{holding}."))
}

/// A footnote for each baseline that gives wrong answers for a known reason.
fn defects(all: &[Measurement]) -> Vec<String> {
    let mut notes = vec![];
    for label in distinct(all.iter().map(|r| &r.label)) {
        let wrong = |r: &&Measurement| r.label == label && r.is_disqualified();
        let share = |r: &Measurement| {
            format!("{} of {} {}", count(r.structure_errors as u64), count(r.checked_rays as u64), r.workload)
        };
        let shares: Vec<String> = all.iter().filter(wrong).map(share).collect();
        let structure = all.iter().find(wrong).map(|r| r.structure.as_str());
        if let Some(defect) = structure.and_then(known_defect) {
            notes.push(format!("{label} answers {} rays wrong; its known defects: {defect}.", shares.join(", ")));
        }
    }
    notes
}

/// A footnote for each triangle test that finds another number of hits than the exact one, by more than 1 %: no check of a structure by its
/// own test tells that.
fn unfit_tests(all: &[Measurement]) -> Vec<String> {
    let exact = |of: &Measurement| {
        let same = |r: &&Measurement| r.workload_hash == of.workload_hash && r.counted_rays == of.counted_rays;
        all.iter().filter(|r| r.triangle_test == Exact::NAME).find(same).map(|r| r.hits)
    };
    let mut notes: Vec<String> = vec![];
    for record in all.iter().filter(|r| r.mrays_per_s.is_some()) {
        let Some(hits) = exact(record).filter(|&hits| 100 * hits.abs_diff(record.hits) > hits) else { continue };
        let note = format!(
            "By {} {} of {} {} rays hit something, by exact arithmetic {}: its speed is one of wrong answers.",
            record.triangle_test,
            count(record.hits as u64),
            count(record.counted_rays as u64),
            record.workload,
            count(hits as u64)
        );
        if !notes.contains(&note) {
            notes.push(note);
        }
    }
    notes
}

fn speed(own: &Measurement, best: f64) -> Cell {
    let errors = own.structure_errors;
    match own.mrays_per_s {
        Some(speed) => {
            Cell::from(speed).sampled(own.sampled).with(if speed >= best { Tone::Best } else { Tone::Plain })
        }
        None if errors == 0 && own.declined.is_some() => "declined".into(),
        None => {
            let (wrong, of) = (errors as u64, own.checked_rays as u64);
            Cell::from(Value::Errors { wrong, of }).with(Tone::Wrong)
        }
    }
}

#[cfg(test)]
mod tests;
