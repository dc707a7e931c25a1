use super::{AccuracyRecord, RayKind};
use crate::report::number::count;
use crate::report::plot::{Point, Scatter};

/// Error against time, of the records of one scene and workload.
pub fn figure(records: &[AccuracyRecord]) -> Scatter {
    let first = &records[0];
    let stand_in = if first.stand_in { " (stand-in)" } else { "" };
    let rays = records.iter().map(|record| record.judged).max().unwrap_or(0);
    let what = first.rays.parse().map_or("rays of a file", RayKind::description);
    let point = |record: &AccuracyRecord| Point {
        x: record.ns_per_ray,
        y: 100.0 * record.error_bound,
        is_bound: record.errors() == 0,
        is_front: record.dominated_by.is_none(),
        label: record.triangle_test.clone(),
        group: structure(record),
    };
    Scatter {
        title: format!("{}{stand_in}: {} {what}", first.scene, count(rays)),
        x_title: "ns per ray, one thread".into(),
        y_title: "wrong hits, % at most (95 % confidence)".into(),
        points: records.iter().map(point).collect(),
    }
}

fn structure(record: &AccuracyRecord) -> String {
    let (name, keys) = record.label.split_once(':').unwrap_or((&record.label, ""));
    let keys: Vec<&str> = keys.split(',').filter(|key| !key.is_empty() && !key.starts_with("test=")).collect();
    if keys.is_empty() { name.into() } else { format!("{name}:{}", keys.join(",")) }
}
