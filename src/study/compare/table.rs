//! Records as tables for people.

use super::reference::{Reference, cell};
use super::twins;
use crate::accel::Query;
use crate::report::number::{bytes, count, duration, figures, plural};
use crate::report::words::{distinct, explained, listed};
use crate::report::{Cell, Record, Table, Tone};
use crate::study::Refused;
use crate::study::reference_structures::{documented_defect, is_large};
use crate::triangle::{Exact, TriangleTest};

/// The columns that are printed where all of them are asked for.
const DETAILS: [&str; 8] = ["build", "peak", "memory", "tests", "steps", "instructions", "checked", "sampled"];

/// What of [`scene_table`] fits 80 columns and matters first: times, and the ratios to the last of the references.
pub fn brief_table(records: &[Record], references: &[Reference], refused: &[Refused]) -> Table {
    scene_table(records, &references[references.len().saturating_sub(1)..], refused).without_columns(&DETAILS)
}

/// Said where brute force could check few rays, since there are so many triangles.
fn few_checked(records: &[Record]) -> Option<String> {
    let triangles = records.first()?.triangles;
    let least = records.iter().filter(|r| r.declined.is_none()).map(|r| r.checked_rays).min()?;
    is_large(triangles).then(|| {
        format!(
            "Answers were checked on {} rays of a kind, evenly spread: against so many triangles brute force would take minutes for more.",
            count(least as u64)
        )
    })
}

/// What the [details](brief_table) mean; `first` is the first workload.
pub fn details_legend(first: &str) -> Vec<String> {
    vec![
        format!(
            "build: seen from outside, median over epochs; peak: most memory held during a build. tests, steps: triangle tests and \
             nodes entered for each {first} ray."
        ),
        "checked: least number of rays of a workload held against brute force with the same triangle test. sampled: \
         least share of a workload's rays that was timed; all would take too long. Blank: unknown."
            .into(),
    ]
}

/// What the other columns of the tables of these records mean, once for all tables.
pub fn legend(records: &[Record], references: &[Reference]) -> Vec<String> {
    let columns: Vec<String> = references.iter().map(|reference| format!("x {}", reference.name())).collect();
    let against: Vec<String> = references.iter().map(|reference| format!("against {}", reference.words())).collect();
    let (columns, against) = (columns.join(", "), listed(&against));
    let mut speeds = "Under each kind of rays: million rays a second, median".to_owned();
    if records.iter().any(Record::is_disqualified) {
        speeds += "; n/m wrong: wrong answers to n of m rays, and then no time";
    }
    if records.iter().any(|r| r.mrays_per_s.is_some() && r.sampled) {
        speeds += "; ~: of a part of the rays, all would take too long";
    }
    if records.iter().any(|r| r.query == Query::Any) {
        speeds += "; *: timed by any hit, the others by closest hit";
    }
    let intervals = match records.iter().any(|r| r.epochs > 1) {
        true => {
            ", with the interval that holds the ratio of another run, as little disturbed, in 95 % of cases; =: not distinguishable from 1"
        }
        false => "",
    };
    vec![speeds + ".", format!("{columns}: speed {against}, geometric mean over the row on the same rays{intervals}.")]
}

/// Why structures are refused, each reason once for all tables.
pub fn refusals(refused: &[Refused]) -> Vec<String> {
    let reason = |reason: &String| {
        let of = refused.iter().filter(|r| r.reason == *reason).map(|r| &r.label);
        format!("Refused: {}: {reason}.", listed(&distinct(of)))
    };
    distinct(refused.iter().map(|r| &r.reason)).iter().map(reason).collect()
}

/// The records of one scene, one row for each structure, those that are refused last, with a column of ratios for each of the
/// `references`.
pub fn scene_table(records: &[Record], references: &[Reference], refused: &[Refused]) -> Table {
    let Some(first) = records.first() else { return Table::default() };
    let workloads = distinct(records.iter().map(|r| &r.workload));
    let structures = distinct(records.iter().map(|r| &r.label));
    let of = |label: &str| -> Vec<&Record> { records.iter().filter(|r| r.label == label).collect() };

    let noise = twins(records);
    let instructions = records.iter().any(|r| r.instructions_per_ray.is_some());
    let mut columns: Vec<String> = ["structure", "build", "peak", "memory", "tests", "steps"].map(String::from).into();
    columns.extend(instructions.then(|| "instructions".into()));
    for workload in &workloads {
        let any = records.iter().any(|r| r.workload == *workload && r.query == Query::Any);
        columns.push(format!("{workload}{}", if any { "*" } else { "" }));
    }
    columns.extend(references.iter().map(|reference| format!("x {}", reference.name())));
    columns.extend(["checked", "sampled"].map(String::from));

    let best_of = |workload: &String| {
        let speeds = records.iter().filter(|r| r.workload == *workload).filter_map(|r| r.mrays_per_s);
        speeds.max_by(f64::total_cmp).unwrap_or(f64::INFINITY)
    };
    let best: Vec<f64> = workloads.iter().map(best_of).collect();
    let mut rows: Vec<Vec<Cell>> = structures
        .iter()
        .map(|label| {
            let of = of(label);
            let known = |x: Option<f64>| x.map(figures).into();
            let mut row: Vec<Cell> = vec![
                label.as_str().into(),
                duration(of[0].build_ns as f64).into(),
                of[0].build_peak_bytes.map(bytes).into(),
                // A program that does not know its memory says 0.
                if of[0].bytes > 0 { bytes(of[0].bytes).into() } else { Cell::blank() },
                known(of[0].tests_per_ray),
                known(of[0].steps_per_ray),
            ];
            row.extend(instructions.then(|| known(of[0].instructions_per_ray)));
            for (workload, best) in workloads.iter().zip(&best) {
                row.push(of.iter().find(|r| r.workload == *workload).map_or(Cell::blank(), |r| speed(r, *best)));
            }
            // A row that lacks a time, other than one that it declines, has no mean.
            let asked: Vec<&Record> = of.iter().copied().filter(|r| r.declined.is_none()).collect();
            row.extend(references.iter().map(|reference| {
                let pairs = reference.pairs(records, asked.iter().copied());
                let whole = pairs.len() == asked.len();
                let mut mean = cell(if whole { Reference::ratio(&pairs, &noise) } else { None });
                if asked.len() < of.len() && !mean.text.is_empty() {
                    mean.text += &format!(" ({} of {})", asked.len(), of.len());
                }
                mean
            }));
            let checked = of.iter().filter(|r| r.declined.is_none()).map(|r| r.checked_rays).min();
            row.push(checked.map(|n| count(n as u64)).into());
            row.push(share(&of).into());
            row
        })
        .collect();
    rows.extend(refused.iter().map(|refused| {
        let mut row = vec![Cell::blank(); columns.len()];
        row[0] = refused.label.as_str().into();
        // In the first of the columns that are always printed.
        let times = columns.len() - workloads.len() - references.len() - 2;
        row[times] = Cell::from("refused").with(Tone::Wrong);
        row
    }));

    let degenerate = match first.degenerate {
        0 => String::new(),
        n => format!(" ({} degenerate)", count(n as u64)),
    };
    let stand_in = if first.stand_in { ", stand-in" } else { "" };
    let title = format!("{}: {}{degenerate}{stand_in}", first.scene, plural(first.triangles, "triangle"));
    let mut notes = vec![];
    for record in records {
        let Some(what) = &record.declined else { continue };
        notes.push(format!("{} declines {what}, which {} rays need.", record.label, record.workload));
    }
    notes.extend(defects(records));
    notes.extend(unfit_tests(records));
    notes.extend(few_checked(records));
    notes.extend(control(records));
    explained(Table { title, columns, rows, notes }.without_blank_columns())
}

/// A footnote about the A/A ratios, where there are any.
pub(super) fn control(records: &[Record]) -> Option<String> {
    let (twins, label) = (twins(records), &records.iter().find(|r| r.twin_samples_ns.is_some())?.label);
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

/// A footnote for each baseline that gives wrong answers for a documented reason.
fn defects(records: &[Record]) -> Vec<String> {
    let mut notes = vec![];
    for label in distinct(records.iter().map(|r| &r.label)) {
        let wrong = |r: &&Record| r.label == label && r.is_disqualified();
        let share = |r: &Record| {
            format!("{} of {} {}", count(r.structure_errors as u64), count(r.checked_rays as u64), r.workload)
        };
        let shares: Vec<String> = records.iter().filter(wrong).map(share).collect();
        let structure = records.iter().find(wrong).map(|r| r.structure.as_str());
        if let Some(defect) = structure.and_then(documented_defect) {
            notes.push(format!("{label} answers {} rays wrong; its documented defects: {defect}.", shares.join(", ")));
        }
    }
    notes
}

/// A footnote for each triangle test that finds another number of hits than the exact one, by more than 1 %: no check of a structure by its
/// own test tells that.
fn unfit_tests(records: &[Record]) -> Vec<String> {
    let exact = |of: &Record| {
        let same = |r: &&Record| r.workload_hash == of.workload_hash && r.counted_rays == of.counted_rays;
        records.iter().filter(|r| r.triangle_test == Exact::NAME).find(same).map(|r| r.hits)
    };
    let mut notes: Vec<String> = vec![];
    for record in records.iter().filter(|r| r.mrays_per_s.is_some()) {
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

fn speed(record: &Record, best: f64) -> Cell {
    let errors = record.structure_errors;
    match record.mrays_per_s {
        Some(speed) => Cell::from(format!("{}{}", if record.sampled { "~" } else { "" }, figures(speed)))
            .with(if speed >= best { Tone::Best } else { Tone::Plain }),
        None if errors == 0 && record.declined.is_some() => "declined".into(),
        None => Cell::from(format!("{errors}/{} wrong", record.checked_rays)).with(Tone::Wrong),
    }
}

fn share(of: &[&Record]) -> String {
    let timed = of.iter().filter(|r| r.mrays_per_s.is_some());
    let least = timed.map(|r| r.rays as f64 / r.workload_rays as f64).min_by(f64::total_cmp);
    match least {
        None => String::new(),
        Some(1.0) => "all".into(),
        Some(share) => format!("{}%", figures(share * 100.0)),
    }
}

#[cfg(test)]
mod tests;
