//! The study as a table for people.

use super::{OFFSETS, PointFrom, Row, Sphere};
use crate::report::number::count;
use crate::report::words::{each_once, listed};
use crate::report::{Cell, Statement, Table, Tone};

/// One row for each sphere and kind of point, one column for each way to start: acne and leaks in percent of their rays, from
/// the least to the most of the structures and triangle tests.
pub fn table(study: &[Row]) -> Table {
    let mut rows = vec![];
    for sphere in Sphere::ALL {
        for (point, name) in [(PointFrom::Ray, "o + t d"), (PointFrom::Corners, "corners")] {
            let cell = |name: String| {
                let cases = study.iter().filter(|r| r.sphere == sphere && r.point == point && r.offset == name);
                shown(&cases.collect::<Vec<_>>())
            };
            let cells = OFFSETS.iter().map(|offset| cell(offset.name()));
            rows.push([sphere.to_string().into(), name.into()].into_iter().chain(cells).collect());
        }
    }
    let rays = study.iter().map(|row| row.outward).max().unwrap_or(0);
    let mut notes = vec![
        format!("{} rays outwards, as many inwards; {}", count(rays as u64), over(study).join(", ")),
        "acne: a ray that leaves the sphere hits it. leak: a ray that goes in hits nothing. point: what the way starts from; \
         error-bounded promises something only for points made from the corners."
            .into(),
    ];
    notes.extend(over(study).into_iter().filter_map(|name| own_errors(study, &name)));
    Table {
        title: "Secondary rays of a closed sphere: acne / leaks, percent".into(),
        columns: ["sphere", "point"].map(String::from).into_iter().chain(OFFSETS.map(|o| o.name())).collect(),
        rows,
        notes,
    }
}

fn over(study: &[Row]) -> Vec<String> {
    each_once(study.iter().map(traced))
}

fn traced(row: &Row) -> String {
    // Tests other than a structure's first are part of its label.
    if row.structure.contains(&row.triangle_test) {
        row.structure.clone()
    } else {
        format!("{} over {}", row.structure, row.triangle_test)
    }
}

/// What a triangle test does wrong by itself, left out of the table.
fn own_errors(study: &[Row], name: &str) -> Option<String> {
    let rows = || study.iter().filter(|row| traced(row) == name);
    let wrong: usize = rows().map(|row| row.acne_of_test + row.leaks_of_test).sum();
    let all: usize = rows().map(|row| row.outward + row.inward).sum();
    let mut blind: Vec<String> = rows().filter(|row| row.outward == 0).map(|row| row.sphere.to_string()).collect();
    blind.dedup();
    let mut text = format!("{name}: left out are {} of {} rays", count(wrong as u64), count(all as u64));
    text += " whose wrong answer is its own: exactly, the answer is right";
    if !blind.is_empty() {
        text += &format!("; it does not see the sphere {} at all", blind.join(", "));
    }
    (wrong > 0 || !blind.is_empty()).then_some(text)
}

fn shown(cases: &[&Row]) -> Cell {
    let cases: Vec<&&Row> = cases.iter().filter(|row| row.outward > 0).collect();
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

/// The ways that have neither acne nor leaks on any sphere.
pub fn statements(study: &[Row]) -> Vec<Statement> {
    let of = |name: &str| study.iter().filter(|row| row.offset == name && row.outward > 0).collect::<Vec<_>>();
    let right = |name: &String| of(name).iter().all(|row| row.point != PointFrom::Corners || row.acne + row.leaks == 0);
    let measured: Vec<String> =
        OFFSETS.iter().map(|offset| offset.name()).filter(|name| !of(name).is_empty()).collect();
    let found: Vec<String> = measured.iter().filter(|name| right(name)).cloned().collect();
    let sentence = match &found[..] {
        _ if measured.is_empty() => return vec![],
        [] => format!(
            "None of {} ways to start a secondary ray is free of acne and leaks on all spheres.",
            measured.len()
        ),
        found => format!(
            "Of {} ways to start a secondary ray from a point made from the corners, {} without acne and leaks on all spheres: {}.",
            measured.len(),
            if found.len() == 1 { "one is".to_owned() } else { format!("{} are", found.len()) },
            listed(found)
        ),
    };
    vec![Statement::new("offset", sentence)]
}
