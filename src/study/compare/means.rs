//! Means over scenes, and who won.

use std::collections::BTreeSet;

use super::reference::{Reference, cell};
use super::table::control;
use super::twins;
use crate::measure::Estimate;
use crate::report::number::{count, figures, plural};
use crate::report::words::{ONE_EPOCH, distinct, each_once, ends, explained, interval, listed};
use crate::report::{Cell, Record, Table, Tone};
use crate::study::reference_structures::is_reference;
use crate::triangle::{Exact, TriangleTest};

/// Speeds over all scenes: one row for each structure; a column for each workload, and one for all of them, against the
/// first of the `references`, and one for all against each other reference.
///
/// A mean is over the cases in which the reference has a time. A row that lacks some of them names how many it has, and
/// takes no part in what is the best of a column: means over different scenes cannot be ranked.
pub fn mean_table(records: &[Record], references: &[Reference]) -> Table {
    let workloads = distinct(records.iter().map(|r| &r.workload));
    let structures = distinct(records.iter().map(|r| &r.label));
    let scenes = distinct(records.iter().map(|r| &r.scene));
    let noise = twins(records);

    // The cells of one column: of every structure, and which of them are over all cases.
    let column = |reference: &Reference, workload: Option<&str>| -> Vec<Cell> {
        let asked = |r: &&Record| workload.is_none_or(|w| r.workload == w);
        // A case is there if the reference has a time; what the reference itself is does not matter.
        let has_rival = |r: &&Record| reference.rival(records, r).is_some();
        let related = records.iter().filter(asked).filter(has_rival);
        let cases = each_once(related.map(|r| (&r.scene, &r.workload))).len();
        let of = |label: &String| {
            let pairs = reference.pairs(records, records.iter().filter(asked).filter(|r| r.label == *label));
            (Reference::ratio(&pairs, &noise), pairs.len())
        };
        let rows: Vec<_> = structures.iter().map(of).collect();
        let whole = rows.iter().filter(|(_, n)| *n == cases).filter_map(|(ratio, _)| Some(ratio.as_ref()?.estimate));
        let best = whole.max_by(f64::total_cmp);
        let shown = |(ratio, n): &(Option<Estimate>, usize)| match ratio {
            None => Cell::blank(),
            Some(known) => {
                let text = if workload.is_some() { figures(known.estimate) } else { cell(*ratio).text };
                if *n < cases {
                    return format!("{text} ({n} of {cases})").into();
                }
                let is_best = Some(known.estimate) == best;
                Cell::from(text).with(if is_best { Tone::Best } else { Tone::Plain })
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
        std::iter::once(Cell::from(label.as_str())).chain(cells.iter().map(|column| column[i].clone())).collect()
    };
    let rows: Vec<Vec<Cell>> = structures.iter().enumerate().map(row).collect();

    let untimed = || records.iter().filter(|r| r.mrays_per_s.is_none());
    let wrong = untimed().filter(|r| r.is_disqualified() || r.declined.is_none()).count();
    let declined = untimed().count() - wrong;
    let mut notes = vec![];
    for (n, why) in [(wrong, "with wrong answers"), (declined, "that a structure declines")] {
        if n > 0 {
            notes.push(format!("{} {why} left out.", plural(n, "case")));
        }
    }
    if cells.iter().flatten().any(|cell| cell.text.contains(" of ")) {
        notes.push(
            "(n of m): the mean is over n of the m cases in which the reference has a time; it cannot be ranked with the others."
                .into(),
        );
    }
    notes.extend(uneven(records));
    notes.extend(control(records));
    let over = plural(scenes.len(), "scene");
    let against = references.first().map_or("?", Reference::name);
    let against = if against == "median" { crate::study::reference_structures::REPORT_TREE } else { against };
    let title = format!("Speed x {against}: geometric means over {over}; all: over scenes and workloads");
    explained(Table { title, columns, rows, notes }.without_blank_columns())
}

/// Said where scenes have different numbers of epochs.
fn uneven(records: &[Record]) -> Option<String> {
    let timed = records.iter().filter(|record| record.mrays_per_s.is_some());
    let epochs: BTreeSet<usize> = timed.map(|record| record.epochs).collect();
    let (least, most) = (*epochs.first()?, *epochs.last()?);
    let first = if least == 1 { "the first".to_owned() } else { format!("the first {least}") };
    (least < most)
        .then(|| format!("Scenes have {least} to {most} epochs: means over all of them are of {first} of each."))
}

/// The structure that is the fastest over all cases.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Winner {
    /// Its label, and that of another one where the two cannot be told apart, or how many there are; of one epoch, which decides nothing, with a word of that.
    pub names: String,
    /// Which one it is, by how much, and how many of its answers were checked.
    pub sentence: String,
}

/// The fastest structure. Nothing where no two structures have a time in all cases.
///
/// The winner is held against `reference`, if that is a structure; else against the better BVH of obvhs, if that is not the winner;
/// else against the one that comes next.
pub fn winner(records: &[Record], reference: Option<&str>) -> Option<Winner> {
    let labels = distinct(records.iter().map(|r| &r.label));
    let of = |label: &str| -> Vec<&Record> { records.iter().filter(|r| r.label == label).collect() };
    let cases = labels.iter().map(|label| of(label).len()).max()?;
    let whole: Vec<&String> = labels
        .iter()
        .filter(|label| {
            let own = of(label);
            own.len() == cases && own.iter().all(|r| r.mrays_per_s.is_some())
        })
        .collect();
    let noise = twins(records);
    let ratio = |one: &str, other: &str| {
        let other = Reference::Structure(other.into());
        let pairs = other.pairs(records, of(one));
        (pairs.len() == cases).then(|| Reference::ratio(&pairs, &noise)).flatten()
    };
    // All are held against the same one, which is timed on the most rays: ratios to one that is slow are of few rays.
    let rays = |label: &String| of(label).iter().map(|r| r.rays).sum::<usize>();
    let first = *whole.iter().rev().max_by_key(|label| rays(label))?;
    let mut order: Vec<(&String, f64)> = vec![];
    for &label in &whole {
        order.push((label, ratio(label, first)?.estimate));
    }
    order.sort_by(|a, b| b.1.total_cmp(&a.1));
    let best = order.first()?.0;
    let next = reference.filter(|label| *label != best.as_str() && whole.iter().any(|w| w == label));
    let second = order.get(1)?.0.as_str();
    // Without a reference it is held against the better BVH of obvhs, as in the tables.
    let others = || order.iter().map(|(label, _)| label.as_str());
    let is_obvhs = |label: &&str| of(label).into_iter().all(is_reference);
    let obvhs = others().find(is_obvhs).filter(|_| reference.is_none() && !is_obvhs(&best.as_str()));
    let next = next.or(obvhs).unwrap_or(second);
    // The winner is held against all others: by chance one of them would too easily seem slower.
    let looks = order.len() - 1;
    let ratio = |one: &str, other: &str| ratio(one, other).map(|by| by.ratio_among(looks));
    let by = ratio(best, next)?;

    let over =
        match (distinct(records.iter().map(|r| &r.scene)).len(), distinct(records.iter().map(|r| &r.workload)).len()) {
            (1, 1) => String::new(),
            (scenes, kinds) => format!("Over {} and {} of rays, ", plural(scenes, "scene"), plural(kinds, "kind")),
        };
    // Who comes after it may be as fast; one epoch decides nothing.
    let is_level = |by: &Estimate| by.interval.is_some() && by.holds(1.0);
    let after = others().skip(1).filter(|label| *label != next).filter_map(|label| Some((label, ratio(best, label)?)));
    let level: Vec<(&str, Estimate)> = after.clone().filter(|(_, by)| is_level(by)).collect();
    let equals: Vec<&str> =
        is_level(&by).then_some(next).into_iter().chain(level.iter().map(|(label, _)| *label)).collect();
    let names = match equals[..] {
        _ if by.interval.is_none() => format!("{best} {ONE_EPOCH}"),
        [] => best.clone(),
        [other] => format!("{best} or {other}"),
        _ => format!("{best} or {} others", equals.len()),
    };
    let told = if is_level(&by) {
        format!("{over}{best} and {next} cannot be told apart: {} times as many rays a second", interval(by))
    } else {
        let ends = ends(by);
        format!("{over}{best} answers {} times as many rays a second as {next} {ends}", figures(by.estimate))
    };
    let checked = match of(best).iter().map(|r| r.checked_rays).sum::<usize>() {
        0 => format!("the answers of {best} are not checked"),
        rays => {
            let own = match of(best)[0].triangle_test.as_str() {
                Exact::NAME => String::new(),
                own => format!(" by its own triangle test, {own}"),
            };
            format!("no answer of {best} is wrong in {} checked rays{own}", count(rays as u64))
        }
    };
    let wrong: Vec<String> = labels.iter().filter_map(|label| wrong(label, &of(label))).collect();
    let wrong =
        if wrong.is_empty() { String::new() } else { format!(" Wrong answers, and so no time: {}.", listed(&wrong)) };
    let left = labels.len() - whole.len();
    let left = match left {
        0 => String::new(),
        n => format!(" Not ranked, without a time in some of the cases: {}.", plural(n, "structure")),
    };
    let level = match &level[..] {
        [] => {
            let next = after.clone().next().filter(|(label, by)| *label == second && by.interval.is_none());
            next.map_or(String::new(), |(_, by)| format!(" Next: {second}, {}.", interval(by)))
        }
        [(label, by)] => format!(" {label} cannot be told apart from it: {}.", interval(*by)),
        more if more.len() > 3 => format!(" {} others cannot be told apart from it.", more.len()),
        _ => {
            let all: Vec<String> = level.iter().map(|(label, by)| format!("{label} ({})", interval(*by))).collect();
            format!(" These cannot be told apart from it: {}.", listed(&all))
        }
    };
    Some(Winner { names, sentence: format!("{told}; {checked}.{level}{wrong}{left}") })
}

/// A structure with the number of its wrong answers, where there are any.
fn wrong(label: &str, records: &[&Record]) -> Option<String> {
    let errors: usize = records.iter().map(|r| r.structure_errors).sum();
    let checked: usize = records.iter().map(|r| r.checked_rays).sum();
    (errors > 0).then(|| format!("{label} ({} of {} checked rays)", count(errors as u64), count(checked as u64)))
}
