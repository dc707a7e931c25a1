//! Formats a comparison of two runs as tables and sentences.

use super::{Change, Comparison, Finding};
use crate::measure::Estimate;
use crate::report::number::{count, figures, plural};
use crate::report::words::{each_once, listed};
use crate::report::{Cell, Format, Table, Tone};

pub fn tables(comparison: &Comparison) -> Vec<Table> {
    [structures(comparison), cells(comparison)].map(Table::with_interval_note).into()
}

pub fn cautions(comparison: &Comparison) -> Vec<String> {
    let wrong = comparison.wrong.iter().map(|wrong| format!("Wrong: {}: {}.", wrong.case, wrong.what));
    let mut cautions: Vec<String> = wrong.collect();
    cautions.extend(comparison.references.is_empty().then(|| {
        "Times are not normalised, because the runs share no obvhs structure with its own triangle test: a slower \
         machine counts as a change."
            .into()
    }));
    cautions.extend(comparison.machines.as_ref().map(|[old, new]| {
        // Each string in `machines` has the form `processor (SIMD level)`.
        let cpu = |machine: &String| machine.rsplit_once(" (").map(|(cpu, _)| cpu.to_owned());
        let two = if cpu(old) == cpu(new) { "Two instruction sets" } else { "Two machines" };
        format!("{two}, {old} and {new}: they, rather than the code, may cause a change.")
    }));
    if !comparison.settings.is_empty() {
        cautions.push(format!("Settings differ: {}.", listed(&comparison.settings)));
    }
    cautions
}

pub fn sentences(comparison: &Comparison) -> Vec<String> {
    let Some(threshold) = comparison.threshold_percent else { return vec![] };
    let sentence = |change: &Change| {
        let wrong = comparison.wrong.iter().filter(|wrong| wrong.structure == change.structure).count();
        let right = match wrong {
            0 => format!("right on {} checked rays", count(change.checked_rays as u64)),
            n => format!("wrong or changed hits in {}", plural(n, "cell")),
        };
        let slower = || change.time.map_or(String::new(), slower);
        let speed = match change.finding {
            Finding::Faster => slower(),
            Finding::Slower => format!("{}: within the limit of {threshold} %", slower()),
            Finding::Regression => format!("{}: over the limit of {threshold} %", slower()),
            Finding::NoDifference => format!("no change beyond noise, {}", slower()),
            Finding::Inconclusive => format!("inconclusive, the interval contains {threshold} %: {}", slower()),
            Finding::Unknown if change.time.is_some() => {
                "a single epoch gives no interval, so a change cannot be judged: measure more with --epochs".into()
            }
            Finding::Unknown => "not timed in at least one of the runs".into(),
        };
        format!("{}: {right}; {speed}.", change.structure)
    };
    comparison.structures.iter().map(sentence).collect()
}

/// Formats a ratio of times as `9.0 % slower [7.7, 10.4]` or `4.1 % less time [2.0, 6.1]`.
fn slower(time: Estimate) -> String {
    let (of, word): (fn(f64) -> f64, _) =
        if time.estimate < 1.0 { (|x| 100.0 * (1.0 - x), "less time") } else { (|x| 100.0 * (x - 1.0), "slower") };
    let ends = time.interval.map_or(String::new(), |interval| {
        let mut ends = [interval.low, interval.high].map(of);
        ends.sort_by(f64::total_cmp);
        format!(" [{:.1}, {:.1}]", ends[0], ends[1])
    });
    format!("{:.1} % {word}{ends}", of(time.estimate))
}

fn structures(comparison: &Comparison) -> Table {
    let rows = comparison.structures.iter().map(|change| {
        let own = comparison.cells.iter().filter(|cell| cell.structure == change.structure);
        let timed = own.filter_map(|cell| Some((cell, cell.time?.estimate)));
        let worst = timed.max_by(|a, b| a.1.total_cmp(&b.1)).map(|(cell, _)| cell);
        let worst = worst.map_or(Cell::empty(), |cell| percent(cell).noted(place(cell)));
        vec![Cell::from(&change.structure), percent(change), word(change), change.cells.into(), worst]
    });
    let mut notes = vec![];
    if !comparison.references.is_empty() {
        notes.push(format!("Normalised by {}, measured in the same rounds.", comparison.references.join(" and ")));
    }
    let judged = plural(comparison.structures.len(), "structure");
    let looks = if comparison.looks > 1 { format!(" and up to {} looks", comparison.looks) } else { String::new() };
    notes.push(format!("The 95 % intervals hold jointly for {judged}{looks}."));
    notes.extend(comparison.threshold_percent.map(figures).map(|percent| {
        format!(
            "Regression: {percent}% slower or more, with an interval above 0. Inconclusive: otherwise, if the interval \
             contains {percent}%."
        )
    }));
    for (only, whose) in [(&comparison.only_old, "old"), (&comparison.only_new, "new")] {
        if let Some(first) = only.first() {
            notes.push(format!("{} only in the {whose} run, e.g. {first}.", plural(only.len(), "case")));
        }
    }
    let differ = comparison.differences.join("; ");
    let differ = if differ.is_empty() { differ } else { format!("; differs: {differ}") };
    let columns = ["structure", "time", "finding", "cells", "worst cell"];
    let title = format!("Change of time, geometric mean over cells, with 95 % interval{differ}");
    Table::new(title, columns, rows).noted(notes)
}

fn cells(comparison: &Comparison) -> Table {
    let places = each_once(comparison.cells.iter().map(place));
    let mut columns = vec!["scene, rays".to_owned()];
    columns.extend(comparison.structures.iter().map(|change| change.structure.clone()));
    let rows = places.iter().map(|row| {
        let of = |change: &Change| {
            let own = |cell: &&Change| cell.structure == change.structure && place(cell) == *row;
            let Some(cell) = comparison.cells.iter().find(own) else { return Cell::empty() };
            percent(cell).with(if cell.finding == Finding::Regression { Tone::Wrong } else { Tone::Plain })
        };
        [row.as_str().into()].into_iter().chain(comparison.structures.iter().map(of)).collect::<Vec<Cell>>()
    });
    Table::new("Change of time, cell by cell", columns, rows)
}

fn place(cell: &Change) -> String {
    let text = |x: &Option<String>| x.clone().unwrap_or_default();
    format!("{} {}", text(&cell.scene), text(&cell.workload))
}

fn percent(change: &Change) -> Cell {
    change.time.map(|time| Cell::estimate(time.map(|ratio| ratio - 1.0), Format::Change)).unwrap_or_default()
}

fn word(change: &Change) -> Cell {
    match change.finding {
        Finding::Faster => Cell::from("faster").with(Tone::Best),
        Finding::NoDifference => "no difference".into(),
        Finding::Slower => "slower".into(),
        Finding::Regression => Cell::from("regression").with(Tone::Wrong),
        Finding::Inconclusive => "inconclusive".into(),
        Finding::Unknown if change.time.is_some() => "one epoch".into(),
        Finding::Unknown => "not timed".into(),
    }
}
