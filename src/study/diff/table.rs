//! A comparison of runs for people.

use super::{Change, Comparison, Finding, Reproduced};
use crate::report::number::{figures, plural};
use crate::report::words::{each_once, listed};
use crate::report::{Cell, Format, Table, Tone};

/// One table of the structures, one of their cells.
pub fn tables(comparison: &Comparison) -> Vec<Table> {
    [structures(comparison), cells(comparison)].map(Table::explained).into()
}

fn structures(comparison: &Comparison) -> Table {
    let rows = comparison.structures.iter().map(|change| {
        let own = comparison.cells.iter().filter(|cell| cell.structure == change.structure);
        let timed = own.filter_map(|cell| Some((cell, cell.time?.estimate)));
        let worst = timed.max_by(|a, b| a.1.total_cmp(&b.1)).map(|(cell, _)| cell);
        let worst = worst.map_or(Cell::empty(), |cell| percent(cell).noted(place(cell)));
        vec![Cell::from(&change.structure), percent(change), word(change), change.cells.into(), worst]
    });
    let by = if comparison.references.is_empty() {
        "Times are compared as they are, for the runs have no structure of obvhs over its own triangle test in common: a machine that was slower counts as a change."
            .to_owned()
    } else {
        format!("Normalised by {}, measured in the same rounds.", comparison.references.join(" and "))
    };
    let looked_for = comparison.threshold_percent.map(|percent| {
        format!(
            "A regression is a change whose whole interval lies above {}%; too noisy: the interval holds {}%.",
            figures(percent),
            figures(percent)
        )
    });
    let mut notes = vec![by];
    notes.extend(comparison.machines.as_ref().map(|[old, new]| {
        // The lanes stand in brackets.
        let cpu = |machine: &String| machine.rsplit_once(" (").map(|(cpu, _)| cpu.to_owned());
        let two = if cpu(old) == cpu(new) { "Two sets of lanes" } else { "Two machines" };
        format!("{two}, {old} and {new}: what has changed may be due to them and not to the code.")
    }));
    if !comparison.settings.is_empty() {
        notes.push(format!("Settings differ: {}.", listed(&comparison.settings)));
    }
    notes.push(format!(
        "Each interval allows for {} judged together{}: in 95 % of the cases all of them hold.",
        plural(comparison.structures.len(), "structure"),
        if comparison.looks > 1 { format!(" at up to {} looks", comparison.looks) } else { String::new() }
    ));
    notes.extend(looked_for);
    notes.extend(comparison.wrong.iter().map(|wrong| format!("Wrong: {}: {}.", wrong.case, wrong.what)));
    for (only, whose) in [(&comparison.only_old, "old"), (&comparison.only_new, "new")] {
        if let Some(first) = only.first() {
            notes.push(format!("{} in the {whose} run alone, as {first}.", plural(only.len(), "case")));
        }
    }
    let columns = ["structure", "time", "finding", "cells", "worst cell"];
    Table::new("Change of time, geometric mean over cells, with 95 % interval", columns, rows).noted(notes)
}

fn cells(comparison: &Comparison) -> Table {
    let places = each_once(comparison.cells.iter().map(place));
    let mut columns = vec!["scene, rays".to_owned()];
    columns.extend(comparison.structures.iter().map(|change| change.structure.clone()));
    let rows = places.iter().map(|row| {
        let of = |change: &Change| {
            let own = |cell: &&Change| cell.structure == change.structure && place(cell) == *row;
            comparison.cells.iter().find(own).map_or(Cell::empty(), |cell| {
                let tone = if cell.finding == Finding::Regression { Tone::Wrong } else { Tone::Plain };
                percent(cell).with(tone)
            })
        };
        let mut cells: Vec<Cell> = vec![row.as_str().into()];
        cells.extend(comparison.structures.iter().map(of));
        cells
    });
    let Reproduced { ratios, old_in_new, new_in_old, unchanged } = comparison.reproduced;
    let share = |n: usize| format!("{n} of {ratios} ({}%)", figures(100.0 * n as f64 / ratios as f64));
    let reproduced = (ratios > 0).then(|| {
        format!(
            "Of the ratios to the report's tree and to obvhs, {} of the old run lie within the new run's intervals, {} of the new within \
             the old's; {} have not changed, by intervals of the change, which know the spread of both.",
            share(old_in_new),
            share(new_in_old),
            share(unchanged)
        )
    });
    Table::new("Change of time, cell by cell", columns, rows).noted(reproduced.into_iter().collect())
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
        Finding::Undecided => "too noisy".into(),
        Finding::Unknown if change.time.is_some() => "one epoch".into(),
        Finding::Unknown => "no time".into(),
    }
}
