//! Records as tables for people.

use super::cells::{speed as speed_of, twins};
use crate::accel::Query;
use crate::measure::{Difference, Interval, geometric_mean};
use crate::report::number::{bytes, count, duration, figures, plural};
use crate::report::{Cell, Record, Table, Tone};
use crate::study::Refused;
use crate::study::baselines::{REPORT_TREE, documented_defect, is_obvhs};

/// What the columns mean, once for all tables of [`scene_table`]. `first` is the first workload.
pub fn legend(first: &str) -> Vec<String> {
    vec![
        format!(
            "build: seen from outside, median over epochs; peak: most memory held during a build. tests, steps: triangle tests and \
             nodes entered for each {first} ray."
        ),
        "Under each workload: million rays a second, median, on one thread a second that the thread has a core for; n/m wrong: wrong answers to n of m rays, and then no time. \
         A workload with a star is timed by any hit, the others by closest hit."
            .into(),
        format!(
            "x median, x obvhs: speed against the report's tree, {REPORT_TREE}, and against the better BVH of obvhs, geometric mean \
             over the workloads of the row, with the interval that holds the ratio of another run in 95 % of cases. =: no difference, \
             for the interval holds 1 or lies within the noise floor, the most that an A/A ratio (one structure built and timed as two) \
             differs from 1 by. Blank: unknown."
        ),
        "checked: least number of rays of a workload held against brute force with the same triangle test. sampled: \
         least share of a workload's rays that was timed; all would take too long."
            .into(),
    ]
}

/// The records of one scene, one row for each structure, those that are refused last. `notes` are those of the scene.
pub fn scene_table(records: &[Record], refused: &[Refused], notes: &[String]) -> Table {
    let notes = || notes.iter().cloned().chain(refused.iter().map(|r| format!("{}: {}", r.label, r.reason)));
    let Some(first) = records.first() else { return Table { notes: notes().collect(), ..Table::default() } };
    let workloads = names(records, |r| &r.workload);
    let structures = names(records, |r| &r.label);
    let of = |label: &str| -> Vec<&Record> { records.iter().filter(|r| r.label == label).collect() };
    let has_report_tree = records.iter().any(|r| r.label == REPORT_TREE);
    let has_obvhs = records.iter().any(|r| is_obvhs(&r.structure));

    let floor = first.noise_floor.map_or(0.0, libm::log1p);
    let instructions = records.iter().any(|r| r.instructions_per_ray.is_some());
    let mut columns: Vec<String> = ["structure", "build", "peak", "memory", "tests", "steps"].map(String::from).into();
    columns.extend(instructions.then(|| "instructions".into()));
    for workload in &workloads {
        let any = records.iter().any(|r| r.workload == *workload && r.query == Query::Any);
        columns.push(format!("{workload}{}", if any { "*" } else { "" }));
    }
    columns.extend(has_report_tree.then(|| "x median".into()));
    columns.extend(has_obvhs.then(|| "x obvhs".into()));
    columns.extend(["checked", "sampled"].map(String::from));

    let best: Vec<f64> = workloads.iter().map(|w| best_speed(records, w, |_| true).unwrap_or(f64::INFINITY)).collect();
    let mut rows: Vec<Vec<Cell>> = structures
        .iter()
        .map(|label| {
            let of = of(label);
            let known = |x: Option<f64>| x.map_or(Cell::blank(), |x| figures(x).into());
            let mut row: Vec<Cell> = vec![
                label.as_str().into(),
                duration(of[0].build_ns as f64).into(),
                of[0].build_peak_bytes.map_or(Cell::blank(), |peak| bytes(peak).into()),
                bytes(of[0].bytes).into(),
                known(of[0].tests_per_ray),
                known(of[0].steps_per_ray),
            ];
            row.extend(instructions.then(|| known(of[0].instructions_per_ray)));
            for (workload, best) in workloads.iter().zip(&best) {
                row.push(of.iter().find(|r| r.workload == *workload).map_or(Cell::blank(), |r| speed(r, *best)));
            }
            let against =
                |baseline: &dyn Fn(&Record) -> bool| ratio(speed_against(records, &of, baseline, floor), floor);
            row.extend(has_report_tree.then(|| against(&|r| r.label == REPORT_TREE)));
            row.extend(has_obvhs.then(|| against(&|r| is_obvhs(&r.structure))));
            let checked = of.iter().filter(|r| r.declined.is_none()).map(|r| r.checked_rays).min().flatten();
            row.push(checked.map_or(Cell::blank(), |n| count(n as u64).into()));
            row.push(share(&of).into());
            row
        })
        .collect();
    rows.extend(refused.iter().map(|refused| {
        let mut row = vec![Cell::blank(); columns.len()];
        row[0] = refused.label.as_str().into();
        row[1] = Cell::from("refused").with(Tone::Wrong);
        row
    }));

    let degenerate = match first.degenerate {
        0 => String::new(),
        n => format!(" ({} degenerate)", count(n as u64)),
    };
    let stand_in = if first.stand_in { ", stand-in" } else { "" };
    let title = format!("{}: {}{degenerate}{stand_in}", first.scene, plural(first.triangles, "triangle"));
    let mut notes: Vec<String> = notes().collect();
    for record in records {
        let Some(what) = &record.declined else { continue };
        notes.push(format!("{} declines {what}, which {} rays need.", record.label, record.workload));
    }
    notes.extend(defects(records));
    notes.extend(control(records));
    Table { title, columns, rows, notes }
}

/// A footnote about the A/A ratios, where there are any.
fn control(records: &[Record]) -> Option<String> {
    let (twins, label) = (twins(records), &records.iter().find(|r| r.twin_samples_ns.is_some())?.label);
    let floor = libm::exp(twins.log()?) - 1.0;
    let (holding, all) = (twins.holding_one(), twins.ratios.len());
    Some(format!(
        "A/A ({label} twice): noise floor {}%; {holding} of {all} ratios hold 1 in their intervals.",
        figures(floor * 100.0)
    ))
}

/// A footnote for each baseline that gives wrong answers for a documented reason.
fn defects(records: &[Record]) -> Vec<String> {
    let mut notes = vec![];
    for label in names(records, |r| &r.label) {
        let wrong = |r: &&Record| r.label == label && r.structure_errors.unwrap_or(0) > 0;
        let share = |r: &Record| {
            let (errors, checked) = (r.structure_errors.unwrap_or(0), r.checked_rays.unwrap_or(0));
            format!("{} of {} {}", count(errors as u64), count(checked as u64), r.workload)
        };
        let shares: Vec<String> = records.iter().filter(wrong).map(share).collect();
        let structure = records.iter().find(wrong).map(|r| r.structure.as_str());
        if let Some(defect) = structure.and_then(documented_defect) {
            notes.push(format!("{label} answers {} rays wrong; its documented defects: {defect}.", shares.join(", ")));
        }
    }
    notes
}

/// Speed against the report's tree over all scenes: one row for each structure, one column for each workload.
///
/// Only cases in which both have a time count; the notes say how many have none.
pub fn mean_table(records: &[Record]) -> Table {
    let workloads = names(records, |r| &r.workload);
    let structures = names(records, |r| &r.label);
    let scenes = names(records, |r| &r.scene);
    let mean = |label: &str, workload: Option<&str>, baseline: &dyn Fn(&Record) -> bool| -> Option<f64> {
        let ratios: Vec<f64> = records
            .iter()
            .filter(|r| r.label == label && workload.is_none_or(|w| r.workload == w))
            .filter_map(|r| {
                let same: Vec<Record> = records.iter().filter(|b| b.scene == r.scene).cloned().collect();
                Some(r.mrays_per_s? / best_speed(&same, &r.workload, baseline)?)
            })
            .collect();
        geometric_mean(&ratios)
    };
    let report_tree = |r: &Record| r.label == REPORT_TREE;
    let obvhs = |r: &Record| is_obvhs(&r.structure);
    let floor = twins(records).log().unwrap_or(0.0);
    let all = |label: &str, baseline: &dyn Fn(&Record) -> bool| -> Cell {
        let pairs = records.iter().filter(|r| r.label == label && r.mrays_per_s.is_some()).filter_map(|r| {
            let rivals = records.iter().filter(|b| b.scene == r.scene && b.workload == r.workload && baseline(b));
            Some((r, fastest(rivals)?))
        });
        ratio(speed_of(pairs, floor), floor)
    };

    let mut columns = vec!["structure".to_owned()];
    columns.extend(workloads.iter().cloned());
    columns.extend(["all", "all x obvhs"].map(String::from));
    let known = |x: Option<f64>| x.map_or(Cell::blank(), |x| Cell::from(figures(x)));
    let rows = structures
        .iter()
        .map(|label| {
            let mut row = vec![Cell::from(label.as_str())];
            row.extend(workloads.iter().map(|w| known(mean(label, Some(w), &report_tree))));
            row.extend([all(label, &report_tree), all(label, &obvhs)]);
            row
        })
        .collect();

    let untimed = || records.iter().filter(|r| r.mrays_per_s.is_none());
    let wrong = untimed().filter(|r| r.is_disqualified() || r.declined.is_none()).count();
    let declined = untimed().count() - wrong;
    let mut notes = vec![];
    for (n, why) in [(wrong, "with wrong answers"), (declined, "that a structure declines")] {
        if n > 0 {
            notes.push(format!("{} {why} left out.", plural(n, "case")));
        }
    }
    notes.extend(control(records));
    let over = plural(scenes.len(), "scene");
    let title = format!("Speed x {REPORT_TREE}: geometric means over {over}; all: over scenes and workloads");
    Table { title, columns, rows, notes }
}

/// Distinct names in the order of their first appearance.
fn names<'a>(records: &'a [Record], name: impl Fn(&'a Record) -> &'a String) -> Vec<String> {
    let mut names: Vec<String> = vec![];
    for record in records {
        if !names.contains(name(record)) {
            names.push(name(record).clone());
        }
    }
    names
}

/// The greatest speed on `workload` among the records that `counts` admits.
fn best_speed(records: &[Record], workload: &str, counts: impl Fn(&Record) -> bool) -> Option<f64> {
    let speeds = records.iter().filter(|r| r.workload == workload && counts(r)).filter_map(|r| r.mrays_per_s);
    speeds.max_by(f64::total_cmp)
}

/// The fastest of records that have a time.
fn fastest<'a>(records: impl Iterator<Item = &'a Record>) -> Option<&'a Record> {
    records
        .filter(|r| r.mrays_per_s.is_some())
        .max_by(|a, b| a.mrays_per_s.partial_cmp(&b.mrays_per_s).expect("numbers"))
}

/// Geometric mean over the workloads of one structure's speed against the best that `counts` admits.
fn speed_against(records: &[Record], of: &[&Record], counts: &dyn Fn(&Record) -> bool, floor: f64) -> Option<Interval> {
    let asked = of.iter().filter(|r| r.declined.is_none());
    let pairs: Option<Vec<(&Record, &Record)>> = asked
        .map(|r| {
            let rivals = records.iter().filter(|b| b.workload == r.workload && counts(b));
            r.mrays_per_s.and(fastest(rivals)).map(|rival| (*r, rival))
        })
        .collect();
    speed_of(pairs?, floor)
}

/// A ratio with its interval, and a sign where it is no difference.
fn ratio(speed: Option<Interval>, floor: f64) -> Cell {
    let Some(speed) = speed else { return Cell::blank() };
    // A structure against itself is not uncertain.
    if speed.estimate == 1.0 && libm::fabs(libm::log(speed.high) - floor) < 1e-12 {
        return figures(1.0).into();
    }
    let same = if Difference::of(speed, floor) == Difference::None { " =" } else { "" };
    format!("{} [{}, {}]{same}", figures(speed.estimate), figures(speed.low), figures(speed.high)).into()
}

fn speed(record: &Record, best: f64) -> Cell {
    let errors = record.structure_errors.unwrap_or(0);
    match record.mrays_per_s {
        Some(speed) => Cell::from(figures(speed)).with(if speed >= best { Tone::Best } else { Tone::Plain }),
        None if errors == 0 && record.declined.is_some() => "declined".into(),
        None => Cell::from(format!("{errors}/{} wrong", record.checked_rays.unwrap_or(0))).with(Tone::Wrong),
    }
}

/// The least share of a workload's rays that was timed.
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
