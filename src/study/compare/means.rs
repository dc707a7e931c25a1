//! Means over scenes.

use std::collections::BTreeSet;

use super::reference::{Reference, cell};
use super::table::control;
use crate::measure::Estimate;
use crate::report::number::plural;
use crate::report::words::{distinct, each_once};
use crate::report::{Cell, Table, Tone};
use crate::request::REPORT_TREE;
use crate::study::measurement::{Measurement, trace_noise};

/// Speeds over all scenes: one row for each structure; a column for each workload, and one for all of them, against the
/// first of the `references`, and one for all against each other reference.
///
/// A mean is over the cases in which the reference has a time. A row that lacks some of them names how many it has, and
/// takes no part in what is the best of a column: means over different scenes cannot be ranked.
pub fn mean_table(all: &[Measurement], references: &[Reference]) -> Table {
    let workloads = distinct(all.iter().map(|r| &r.workload));
    let structures = distinct(all.iter().map(|r| &r.label));
    let scenes = distinct(all.iter().map(|r| &r.scene));
    let noise = trace_noise(all);

    // The cells of one column: of every structure, and which of them are over all cases.
    let column = |reference: &Reference, workload: Option<&str>| -> Vec<Cell> {
        let asked = |r: &&Measurement| workload.is_none_or(|w| r.workload == w);
        // A case is there if the reference has a time; what the reference itself is does not matter.
        let has_rival = |r: &&Measurement| reference.rival(all, r).is_some();
        let related = all.iter().filter(asked).filter(has_rival);
        let cases = each_once(related.map(|r| (&r.scene, &r.workload))).len();
        let of = |label: &String| {
            let pairs = reference.pairs(all, all.iter().filter(asked).filter(|r| r.label == *label));
            (Reference::ratio(&pairs, &noise), pairs.len())
        };
        let rows: Vec<_> = structures.iter().map(of).collect();
        let whole = rows.iter().filter(|(_, n)| *n == cases).filter_map(|(ratio, _)| Some(ratio.as_ref()?.estimate));
        let best = whole.max_by(f64::total_cmp);
        let shown = |(ratio, n): &(Option<Estimate>, usize)| match ratio {
            None => Cell::empty(),
            Some(known) => {
                let shown = if workload.is_some() { Cell::from(known.estimate) } else { cell(*ratio) };
                if *n < cases {
                    return shown.noted(format!("{n} of {cases}"));
                }
                let is_best = Some(known.estimate) == best;
                shown.with(if is_best { Tone::Best } else { Tone::Plain })
            }
        };
        rows.iter().map(shown).collect()
    };

    let mut columns = vec!["structure".to_owned()];
    let mut cells = vec![];
    for (i, reference) in references.iter().enumerate() {
        if i == 0 {
            columns.extend(workloads.iter().cloned());
            cells.extend(workloads.iter().map(|w| column(reference, Some(w))));
        }
        columns.push(format!("all x {}", reference.name()));
        cells.push(column(reference, None));
    }
    let row = |(i, label): (usize, &String)| {
        std::iter::once(Cell::from(label)).chain(cells.iter().map(|column| column[i].clone())).collect()
    };
    let rows: Vec<Vec<Cell>> = structures.iter().enumerate().map(row).collect();

    let untimed = || all.iter().filter(|r| r.mrays_per_s.is_none());
    let wrong = untimed().filter(|r| r.is_disqualified() || r.declined.is_none()).count();
    let declined = untimed().count() - wrong;
    let mut notes = vec![];
    for (n, why) in [(wrong, "with wrong answers"), (declined, "that a structure declines")] {
        if n > 0 {
            notes.push(format!("{} {why} left out.", plural(n, "case")));
        }
    }
    if cells.iter().flatten().any(|cell| !cell.note.is_empty()) {
        notes.push(
            "(n of m): the mean is over n of the m cases in which the reference has a time; it cannot be ranked with the others."
                .into(),
        );
    }
    notes.extend(uneven(all));
    notes.extend(control(all));
    let over = plural(scenes.len(), "scene");
    let against = references.first().map_or("?", Reference::name);
    let against = if against == "median" { REPORT_TREE } else { against };
    let title = format!("Speed x {against}: geometric means over {over}; all: over scenes and workloads");
    Table::new(title, columns, rows).noted(notes).without_empty_columns().explained()
}

/// Said where scenes have different numbers of epochs.
fn uneven(all: &[Measurement]) -> Option<String> {
    let timed = all.iter().filter(|record| record.mrays_per_s.is_some());
    let epochs: BTreeSet<usize> = timed.map(|record| record.epochs).collect();
    let (least, most) = (*epochs.first()?, *epochs.last()?);
    let first = if least == 1 { "the first".to_owned() } else { format!("the first {least}") };
    (least < most)
        .then(|| format!("Scenes have {least} to {most} epochs: means over all of them are of {first} of each."))
}
