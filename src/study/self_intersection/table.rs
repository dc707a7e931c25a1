//! The study as a table for people.

use super::{OFFSETS, PointFrom, Row, SelfIntersection, Sphere};
use crate::report::number::count;
use crate::report::{Cell, Table, Tone};

/// One row for each sphere and kind of point, one column for each way to start: acne and leaks in percent of their rays, from
/// the least to the most of the structures and triangle tests.
pub fn table(study: &SelfIntersection) -> Table {
    let mut rows = vec![];
    for sphere in Sphere::ALL {
        for (point, name) in [(PointFrom::Ray, "o + t d"), (PointFrom::Corners, "corners")] {
            let cell = |name: String| {
                let cases = study.rows.iter().filter(|r| r.sphere == sphere && r.point == point && r.offset == name);
                shown(&cases.collect::<Vec<_>>())
            };
            let cells = OFFSETS.iter().map(|offset| cell(offset.name()));
            rows.push([sphere.to_string().into(), name.into()].into_iter().chain(cells).collect());
        }
    }
    let mut over: Vec<String> = vec![];
    for row in &study.rows {
        let name = format!("{} over {}", row.structure, row.triangle_test);
        if !over.contains(&name) {
            over.push(name);
        }
    }
    let rays = study.rows.first().map_or(0, |row| row.outward);
    Table {
        title: "Secondary rays of a closed sphere: acne / leaks, percent".into(),
        columns: ["sphere", "point"].map(String::from).into_iter().chain(OFFSETS.map(|o| o.name())).collect(),
        rows,
        notes: vec![
            format!("{} rays outwards, as many inwards; {}", count(rays as u64), over.join(", ")),
            "acne: a ray that leaves the sphere hits it. leak: a ray that goes in hits nothing. point: what the way starts from; \
             error-bounded promises something only for points made from the corners."
                .into(),
        ],
    }
}

fn shown(cases: &[&Row]) -> Cell {
    let acne: Vec<f64> = cases.iter().map(|r| percent(r.acne, r.outward)).collect();
    let leaks: Vec<f64> = cases.iter().map(|r| percent(r.leaks, r.inward)).collect();
    let right = !cases.is_empty() && acne.iter().chain(&leaks).all(|x| *x == 0.0);
    let text = if cases.is_empty() { String::new() } else { format!("{} / {}", range(&acne), range(&leaks)) };
    Cell::from(text).with(if right { Tone::Best } else { Tone::Plain })
}

fn percent(part: usize, whole: usize) -> f64 {
    if whole == 0 { 0.0 } else { 100.0 * part as f64 / whole as f64 }
}

/// The least and the most, once if they read the same.
fn range(values: &[f64]) -> String {
    let least = values.iter().copied().fold(f64::INFINITY, f64::min);
    let most = values.iter().copied().fold(0.0, f64::max);
    let (least, most) = (short(least), short(most));
    if least == most { least } else { format!("{least}-{most}") }
}

/// Two digits; nothing that happened is shown as 0.
fn short(percent: f64) -> String {
    match percent {
        0.0 => "0".into(),
        x if x < 0.1 => format!("{x:.2}"),
        x if x < 10.0 => format!("{x:.1}"),
        x => format!("{x:.0}"),
    }
}
