//! The table of one scene, with notes.

use super::details;
use super::reference::Reference;
use crate::accel::Query;
use crate::report::number::{count, figures, plural};
use crate::report::words::{distinct, each_once, listed};
use crate::report::{Cell, Table, Tone, Value};
use crate::request::known_defect;
use crate::study::epoch::Structure;
use crate::study::measurement::{Measurement, trace_noise};
use crate::triangle::{Exact, TriangleTest};

/// Structures with this option trace many rays per call.
const PACKETS: &str = "batch=packets";

pub fn legend(all: &[Measurement], references: &[Reference]) -> Vec<String> {
    let column = |own: &Reference| format!("x {}: speed against {}", own.name(), own.words());
    let mut ratios = references.iter().map(column).collect::<Vec<_>>().join("; ");
    ratios += "; each is the geometric mean over the workloads of the row, on the same rays";
    if all.iter().any(|r| r.epochs > 1) {
        ratios +=
            ", with 95 % prediction intervals for a rerun on an equally quiet machine; =: not distinguishable from 1";
    }
    let mut speeds = "Workload columns: million rays per second, median".to_owned();
    if all.iter().any(Measurement::is_disqualified) {
        speeds += "; n/m wrong: wrong hits on n of m rays, so no time";
    }
    if all.iter().any(|r| r.mrays_per_s.is_some() && r.sampled) {
        speeds += "; ~: timed on a subset of the rays";
    }
    if all.iter().any(|r| r.query == Query::Any) {
        speeds += "; *: any-hit query, all other columns: closest-hit query";
    }
    let mut legend = vec![speeds + ".", ratios + "."];
    let has = |part: &str| all.iter().any(|r| r.label.contains(part));
    if has(PACKETS) {
        let obvhs = if has("obvhs") { "; obvhs has no such call and traces single rays" } else { "" };
        legend.push(format!("{PACKETS}: many rays per call{obvhs}."));
    }
    legend
}

pub fn refusals(refused: &[&Structure]) -> Vec<String> {
    let reason = |reason: &String| {
        let of = refused.iter().filter(|own| own.refused.as_ref() == Some(reason)).map(|own| &own.label);
        format!("Refused: {}: {reason}.", listed(&distinct(of)))
    };
    distinct(refused.iter().filter_map(|own| own.refused.as_ref())).iter().map(reason).collect()
}

pub fn nothing_measured(scene: &str, refused: &[&Structure]) -> Table {
    let title = format!("{scene}: no structure could be measured");
    Table::of(title, refused, &[("structure", &|own| (&own.label).into())]).of_one_scene()
}

pub fn scene_table(all: &[Measurement], references: &[Reference], refused: &[&Structure], wide: bool) -> Table {
    let Some(first) = all.first() else { return Table::default() };
    let degenerate = match first.degenerate {
        0 => String::new(),
        n => format!(" ({} degenerate)", count(n as u64)),
    };
    let stand_in = if first.stand_in { ", stand-in" } else { "" };
    let triangles = plural(first.triangles, "triangle");
    let title = format!("{}: {triangles}{degenerate}{stand_in}; million rays per second", first.scene);
    let structures = distinct(all.iter().map(|r| &r.label));
    let mut table = Table::of(title, &structures, &[("structure", &|label| (*label).into())]);
    for workload in distinct(all.iter().map(|r| &r.workload)) {
        let own = || all.iter().filter(|r| r.workload == workload);
        let best = own().filter_map(|r| r.mrays_per_s).max_by(f64::total_cmp).unwrap_or(f64::INFINITY);
        let cell = |label: &String| own().find(|r| r.label == *label).map(|r| speed(r, best)).into();
        let mark = if own().any(|r| r.query == Query::Any) { "*" } else { "" };
        table.push_column(format!("{workload}{mark}"), structures.iter().map(cell));
    }
    let noise = trace_noise(all);
    for reference in references {
        let mean = |label: &String| {
            // Declined workloads are excluded. The mean is empty if the structure or the reference has no time on a
            // remaining workload.
            let own: Vec<&Measurement> = all.iter().filter(|r| r.label == *label).collect();
            let timed: Vec<&Measurement> = own.iter().copied().filter(|r| r.declined.is_none()).collect();
            let pairs = reference.pairs(all, timed.iter().copied());
            let ratio = Reference::ratio(&pairs, &noise).filter(|_| pairs.len() == timed.len());
            let mean = Cell::from(ratio.map(Cell::ratio));
            let is_part = timed.len() < own.len() && !mean.is_empty();
            if is_part { mean.noted(format!("{} of {}", timed.len(), own.len())) } else { mean }
        };
        table.push_column(format!("x {}", reference.name()), structures.iter().map(mean));
    }
    if wide {
        details::add_columns(&mut table, all, &structures);
    }
    for own in refused {
        let mut row = vec![Cell::empty(); table.columns.len()];
        row[0] = Cell::from(&own.label);
        row[1] = Cell::from("refused").with(Tone::Wrong);
        table.rows.push(row);
    }

    let declined = |own: &Measurement| {
        Some(format!("{} declines {}, which {} rays need.", own.label, own.declined.as_ref()?, own.workload))
    };
    let mut notes: Vec<String> = all.iter().filter_map(declined).collect();
    notes.extend(defects(all));
    notes.extend(unfit_tests(all));
    notes.extend(aa_noise_note(all));
    table.noted(notes).without_empty_columns().of_one_scene().with_interval_note()
}

pub(super) fn aa_noise_note(all: &[Measurement]) -> Option<String> {
    let (twins, label) = (trace_noise(all), &all.iter().find(|r| r.twin_samples_ns.is_some())?.label);
    let noise = libm::exp(twins.log()?) - 1.0;
    let holding = twins.containing_one();
    let holding = holding.map_or(String::new(), |(n, all)| format!("; {n} of {all} intervals of the ratio contain 1"));
    // An estimate of 0 does not prove a lack of noise. The variation between epochs may hide the noise.
    let noise = match noise {
        0.0 => "none beyond the variation of the epochs".into(),
        _ => format!("{}%", figures(noise * 100.0)),
    };
    Some(format!("A/A noise ({label} built twice and compared with itself): {noise}{holding}."))
}

fn defects(all: &[Measurement]) -> Vec<String> {
    let note = |label: &String| {
        let wrong = || all.iter().filter(|r| r.label == *label && r.is_disqualified());
        let defect = known_defect(&wrong().next()?.structure)?;
        let share = |r: &Measurement| {
            format!("{} of {} {}", count(r.wrong_hits as u64), count(r.checked_rays as u64), r.workload)
        };
        let shares: Vec<String> = wrong().map(share).collect();
        Some(format!("{label} returns wrong hits on {} rays; known defects: {defect}.", shares.join(", ")))
    };
    distinct(all.iter().map(|r| &r.label)).iter().filter_map(note).collect()
}

/// A triangle test can miss hits although all checks pass.
///
/// The checks use brute force with the same triangle test as the structure.
fn unfit_tests(all: &[Measurement]) -> Vec<String> {
    let exact = |of: &Measurement| {
        let same = |r: &&Measurement| r.workload_hash == of.workload_hash && r.counts.rays == of.counts.rays;
        all.iter().filter(|r| r.triangle_test == Exact::NAME).find(same).map(|r| r.counts.hits)
    };
    let note = |own: &Measurement| {
        let exact = exact(own).filter(|&hits| 100 * hits.abs_diff(own.counts.hits) > hits)?;
        let [hits, rays, exact] = [own.counts.hits, own.counts.rays, exact].map(|n| count(n as u64));
        let (test, workload) = (&own.triangle_test, &own.workload);
        Some(format!(
            "{test} finds hits for {hits} of {rays} {workload} rays, exact arithmetic for {exact}: its speed is not \
             comparable."
        ))
    };
    each_once(all.iter().filter(|r| r.mrays_per_s.is_some()).filter_map(note))
}

fn speed(own: &Measurement, best: f64) -> Cell {
    if let Some(speed) = own.mrays_per_s {
        return Cell::from(speed).sampled(own.sampled).with(if speed >= best { Tone::Best } else { Tone::Plain });
    }
    let (wrong, of) = (own.wrong_hits as u64, own.checked_rays as u64);
    match own.declined {
        _ if wrong > 0 => Cell::from(Value::Errors { wrong, of }).with(Tone::Wrong),
        Some(_) => "declined".into(),
        // The structure has wrong hits on another workload.
        None => Cell::from("wrong").with(Tone::Wrong),
    }
}

#[cfg(test)]
mod tests;
