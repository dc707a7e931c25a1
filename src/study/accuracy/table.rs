//! The tables of the accuracy study.

use super::judged::{Judged, JudgedRays};
use crate::report::number::count;
use crate::report::{Cell, Format, Table, Tone};
use crate::validate::Ulps;

pub fn table(of_kind: &JudgedRays) -> Table {
    let JudgedRays { epoch, kind, structures, .. } = of_kind;
    let title = format!(
        "{}: {} triangles{}; {kind}: {} {}, {} hit",
        epoch.scene,
        count(epoch.triangles as u64),
        if epoch.stand_in { ", stand-in" } else { "" },
        count(of_kind.most(|own| own.errors.rays)),
        of_kind.description(),
        count(of_kind.most(|own| own.errors.hits)),
    );
    let judged = structures.iter().filter(|own| own.is_sampled()).map(|own| {
        let Judged { structure, errors, .. } = own;
        format!("{}: judged on {} of the rays", structure.label, count(errors.rays))
    });
    let most = of_kind.most(|own| own.rays.rays as u64);
    let timed = structures.iter().filter(|own| (own.rays.rays as u64) < most).map(|own| {
        let [few, all] = [own.rays.rays as u64, most].map(count);
        format!("{}: timed on {few} of the {all} rays on which other structures are timed", own.structure.label)
    });
    let notes: Vec<String> = judged.chain(timed).collect();
    let tone = |own: &Judged| if own.dominated_by.is_none() { Tone::Best } else { Tone::Plain };
    let errors = |n: u64| Cell::from(n).with(if n > 0 { Tone::Wrong } else { Tone::Plain });
    Table::of(
        title,
        structures,
        &[
            ("structure", &|own| own.structure.label.as_str().into()),
            ("ns/ray", &|own| Cell::from(own.ns_per_ray).with(tone(own))),
            ("slowest", &|own| own.rays.slowest_ns.map(|ns| ns as f64).into()),
            ("error", &|own| Cell::number(own.error, Format::Percent).with(tone(own))),
            ("at most", &|own| Cell::number(own.error_bound, Format::Percent)),
            ("missed", &|own| errors(own.errors.missed)),
            ("false", &|own| errors(own.errors.false_hits)),
            ("depth", &|own| errors(own.errors.wrong_depth)),
            ("primitive", &|own| own.errors.wrong_primitive.into()),
            ("ulps: median", &|own| ulps(own, |ulps| ulps.median)),
            ("99 %", &|own| ulps(own, |ulps| ulps.p99)),
            ("max", &|own| ulps(own, |ulps| ulps.max)),
            ("dominated by", &|own| own.dominated_by.into()),
        ],
    )
    .noted(notes)
    .of_one_scene()
}

fn ulps(own: &Judged, value: fn(&Ulps) -> f64) -> Cell {
    own.errors.ulps.as_ref().map(value).into()
}

pub const LEGEND: [&str; 4] = [
    "slowest: nanoseconds of the slowest ray, traced alone, including the call.",
    "error: share of rays with a wrong result by exact arithmetic: a missed hit, a false hit, or a depth that is off by \
     more than 4 units in the last place and more than 1e-6. at most: its upper bound with 95 % confidence (Clopper and \
     Pearson; about 3/n for no error in n rays).",
    "primitive: hits on a triangle that is not the nearest, however small the difference; not part of the error. ulps: \
     error of t on the correct triangle; at most 0.5 is correctly rounded.",
    "dominated by: a structure that is at most as slow and at most as wrong, and better in one of the two; blank on \
     the Pareto front (no other structure is at most as slow, at most as wrong, and better in one of the two).",
];

/// One row per scene, workload and structure.
pub fn data(all: &[JudgedRays]) -> Table {
    let rows = all.iter().flat_map(|of_kind| of_kind.structures.iter().map(move |own| (of_kind, own)));
    type Row<'a> = (&'a JudgedRays<'a>, &'a Judged<'a>);
    Table::of(
        "",
        rows,
        &[
            ("scene", &|(of_kind, _): &Row| of_kind.epoch.title().into()),
            ("scene_hash", &|(of_kind, _)| of_kind.epoch.scene_hash.as_str().into()),
            ("triangles", &|(of_kind, _)| of_kind.epoch.triangles.into()),
            ("structure", &|(_, own)| own.structure.name.as_str().into()),
            ("label", &|(_, own)| own.structure.label.as_str().into()),
            ("triangle_test", &|(_, own)| own.structure.triangle_test.as_str().into()),
            ("rays", &|(of_kind, _)| of_kind.kind.into()),
            ("seed", &|(of_kind, _)| of_kind.case.settings.seed.into()),
            ("judged", &|(_, own)| own.errors.rays.into()),
            ("sampled", &|(_, own)| own.is_sampled().into()),
            ("hits", &|(_, own)| own.errors.hits.into()),
            ("missed", &|(_, own)| own.errors.missed.into()),
            ("false_hits", &|(_, own)| own.errors.false_hits.into()),
            ("wrong_depth", &|(_, own)| own.errors.wrong_depth.into()),
            ("wrong_primitive", &|(_, own)| own.errors.wrong_primitive.into()),
            ("error", &|(_, own)| own.error.into()),
            ("error_bound", &|(_, own)| own.error_bound.into()),
            ("ulps_median", &|(_, own)| ulps(own, |ulps| ulps.median)),
            ("ulps_p99", &|(_, own)| ulps(own, |ulps| ulps.p99)),
            ("ulps_max", &|(_, own)| ulps(own, |ulps| ulps.max)),
            ("ns_per_ray", &|(_, own)| own.ns_per_ray.into()),
            ("slowest_ns", &|(_, own)| own.rays.slowest_ns.into()),
            ("timed", &|(_, own)| own.rays.rays.into()),
            ("runs", &|(_, own)| own.rays.ns.len().into()),
            ("dominated_by", &|(_, own)| own.dominated_by.into()),
        ],
    )
}
