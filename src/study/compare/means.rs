//! Means over scenes.

use super::Reference;
use super::table::aa_noise_note;
use crate::measure::Estimate;
use crate::report::number::plural;
use crate::report::words::{distinct, each_once, listed};
use crate::report::{Cell, Table, Tone};
use crate::study::measurement::{Measurement, trace_noise};

/// A mean skips workloads on which the structure or the reference has no time.
pub fn mean_table(all: &[Measurement], references: &[Reference]) -> Table {
    let workloads = distinct(all.iter().map(|r| &r.workload));
    let structures = distinct(all.iter().map(|r| &r.label));
    let noise = trace_noise(all);

    let column = |reference: &Reference, workload: Option<&str>| -> Vec<Cell> {
        let is_of_workload = |r: &&Measurement| workload.is_none_or(|w| r.workload == w);
        let has_rival = |r: &&Measurement| reference.rival(all, r).is_some();
        let related = all.iter().filter(is_of_workload).filter(has_rival);
        let cases = each_once(related.map(|r| (&r.scene, &r.workload))).len();
        let of = |label: &String| {
            let pairs = reference.pairs(all, all.iter().filter(is_of_workload).filter(|r| r.label == *label));
            (Reference::ratio(&pairs, &noise), pairs.len())
        };
        let rows: Vec<_> = structures.iter().map(of).collect();
        let whole = rows.iter().filter(|(_, n)| *n == cases).filter_map(|(ratio, _)| Some(ratio.as_ref()?.estimate));
        let best = whole.max_by(f64::total_cmp);
        let shown = |(ratio, n): &(Option<Estimate>, usize)| {
            let Some(known) = *ratio else { return Cell::empty() };
            let shown = if workload.is_some() { Cell::from(known.estimate) } else { Cell::ratio(known) };
            if *n < cases {
                return shown.noted(format!("{n} of {cases}"));
            }
            shown.with(if Some(known.estimate) == best { Tone::Best } else { Tone::Plain })
        };
        rows.iter().map(shown).collect()
    };

    let against = references.first().map_or("?".into(), Reference::words);
    let over = plural(distinct(all.iter().map(|r| &r.scene)).len(), "scene");
    let title =
        format!("Speed relative to {against}: geometric means over {over} (column all: over scenes and workloads)");
    let mut table = Table::of(title, &structures, &[("structure", &|label| (*label).into())]);
    if let Some(first) = references.first() {
        workloads.iter().for_each(|workload| table.push_column(workload, column(first, Some(workload))));
    }
    for reference in references {
        table.push_column(format!("all x {}", reference.name()), column(reference, None));
    }

    let untimed = || all.iter().filter(|r| r.mrays_per_s.is_none());
    let wrong = untimed().filter(|r| r.is_disqualified() || r.declined.is_none()).count();
    let declined = untimed().count() - wrong;
    // Refused structures have no measurements.
    let cells = each_once(all.iter().map(|r| (&r.scene, &r.workload))).len();
    let missing = (structures.len() * cells).saturating_sub(all.len());
    let reasons = [
        (wrong, "because of wrong hits"),
        (declined, "because the structure declines the rays"),
        (missing, "because the structure is refused on the scene"),
    ];
    let reasons = reasons.iter().filter(|(n, _)| *n > 0).map(|(n, why)| format!("{n} {why}"));
    let reasons: Vec<String> = reasons.collect();
    let mut notes = vec![];
    if !reasons.is_empty() {
        notes.push(format!("Missing speeds (one structure on one workload of one scene): {}.", listed(&reasons)));
        let note = "Means are over all cells in which a structure has a time; rankings use only the cells in which all \
                    ranked structures, with exact or f64 triangle tests and in single precision, have a time.";
        notes.push(note.into());
    }
    notes.extend(table.rows.iter().flatten().any(|cell| !cell.note.is_empty()).then(|| {
        "(n of m): mean over only n of the m cells in which the reference structure has a time; not comparable with the \
         other rows."
            .into()
    }));
    notes.extend(uneven(all));
    notes.extend(aa_noise_note(all));
    table.noted(notes).without_empty_columns().with_interval_note()
}

fn uneven(all: &[Measurement]) -> Option<String> {
    let epochs = || all.iter().filter(|r| r.mrays_per_s.is_some()).map(|r| r.epochs);
    let (least, most) = (epochs().min()?, epochs().max()?);
    let first = if least == 1 { "the first".to_owned() } else { format!("the first {least}") };
    (least < most).then(|| format!("Scenes have {least} to {most} epochs: intervals of means use {first} of each."))
}
