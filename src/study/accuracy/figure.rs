use super::{AccuracyRecord, RayKind};
use crate::report::number::count;
use crate::report::plot::{LABELLED, Panel, Point, Scatter};

/// Error against time: one panel for each scene and kind of rays.
pub fn figure(records: &[AccuracyRecord]) -> Scatter {
    let panel = |of_kind: &[AccuracyRecord]| {
        let first = &of_kind[0];
        let stand_in = if first.stand_in { " (stand-in)" } else { "" };
        let rays = of_kind.iter().map(|record| record.judged).max().unwrap_or(0);
        let what = first.rays.parse().map_or("rays of a file", RayKind::description);
        let point = |record: &AccuracyRecord| Point {
            x: record.ns_per_ray,
            y: 100.0 * record.error_bound,
            is_bound: record.errors() == 0,
            is_front: record.dominated_by.is_none(),
            label: record.triangle_test.clone(),
            group: structure(record),
        };
        Panel {
            title: format!("{}{stand_in}: {} {what}", first.scene, count(rays)),
            x_title: "ns per ray, one thread".into(),
            y_title: "wrong hits, % at most (95 % confidence)".into(),
            points: of_kind.iter().map(point).collect(),
        }
    };
    let panels: Vec<Panel> = records.chunk_by(AccuracyRecord::is_beside).map(panel).collect();
    let mut notes = vec![
        "Labels name the triangle test, colours the structure. Filled: nothing is faster and less wrong.".into(),
        "Arrow: not one wrong answer was seen in n rays; the dot is the upper bound with 95 % confidence, about 3/n."
            .into(),
    ];
    if panels.iter().any(|panel| panel.points.len() > LABELLED) {
        notes.push(format!("Of more than {LABELLED} points those that are filled are labelled."));
    }
    Scatter { panels, notes }
}

fn structure(record: &AccuracyRecord) -> String {
    let (name, keys) = record.label.split_once(':').unwrap_or((&record.label, ""));
    let keys: Vec<&str> = keys.split(',').filter(|key| !key.is_empty() && !key.starts_with("test=")).collect();
    if keys.is_empty() { name.into() } else { format!("{name}:{}", keys.join(",")) }
}
