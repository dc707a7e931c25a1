use super::*;
use crate::report::{Record, timed_example};

fn record(label: &str, workload: &str, ns: &[f64], preset: Option<&str>) -> Record {
    Record {
        config: preset.map_or(serde_json::json!({}), |preset| serde_json::json!({ "preset": preset })),
        triangles: 10,
        bytes: 800,
        build_ns: if preset.is_some() { 50 } else { 100 },
        ..timed_example(label, workload, ns, 1)
    }
}

#[test]
fn each_cell_is_held_against_the_fastest_rival_there() {
    let rivals = |workload: &str, a: f64, b: f64| {
        [
            record("obvhs-bvh2:preset=very-slow", workload, &[a; 3], Some("very-slow")),
            record("obvhs-cwbvh:preset=fast", workload, &[b; 3], Some("fast")),
        ]
    };
    let ours = ["primary", "random"].map(|w| record("sah-hybrid", w, &[100.0; 3], None));
    let records = [&rivals("primary", 200.0, 300.0)[..], &rivals("random", 900.0, 800.0), &ours].concat();
    let Partitions { rows, overall, .. } = Partitions::of(records);
    assert_eq!(rows.len(), 1);
    let speed = |i: usize| {
        (
            rows[0].cells[i].speed.map(|speed| (speed.estimate * 1e9).round() * 1e-9).unwrap(),
            rows[0].cells[i].baseline.as_deref().unwrap(),
        )
    };
    assert_eq!(speed(0), (2.0, "obvhs-bvh2:preset=very-slow"));
    assert_eq!(speed(1), (8.0, "obvhs-cwbvh:preset=fast"));
    assert!((rows[0].all.unwrap().estimate - 4.0).abs() < 1e-12);
    assert_eq!((rows[0].build, rows[0].bytes), (Some(2.0), 80.0));
    assert_eq!(overall, []);
}

#[test]
fn what_has_no_time_has_no_speed_and_no_mean() {
    let records = [
        record("obvhs-bvh2:preset=fast", "primary", &[10.0; 3], Some("fast")),
        record("sah-bvh", "primary", &[5.0; 3], None),
        record("sah-bvh", "random", &[5.0; 3], None),
    ];
    let rows = Partitions::of(records.into()).rows;
    assert!(rows[0].cells[0].speed.is_some() && rows[0].cells[1].speed.is_none());
    assert_eq!(rows[0].all, None);
}

#[test]
fn over_several_scenes_the_means_are_of_all_cells() {
    let on = |scene: &str, record: Record| Record { scene: scene.into(), ..record };
    let dearest = |ns: f64| record("obvhs-bvh2:preset=very-slow", "primary", &[ns; 3], Some("very-slow"));
    let own = || record("sah-bvh", "primary", &[100.0; 3], None);
    // Refused on the other scene: its mean would be of other cells.
    let on_one = || record("sah-kd", "primary", &[10.0; 3], None);
    let records = [on("A", dearest(200.0)), on("A", own()), on("A", on_one()), on("B", dearest(800.0)), on("B", own())];
    let answer = Partitions::of(records.into());
    let [all] = &answer.overall[..] else { panic!("{:?}", answer.overall) };
    assert_eq!((all.structure.as_str(), all.build), ("sah-bvh", Some(2.0)));
    assert!((all.all.unwrap().estimate - 4.0).abs() < 1e-12);
    assert_eq!(all.kinds, [("primary".to_owned(), all.all)]);
    let tables = tables(&answer);
    assert_eq!(tables.iter().map(|table| table.rows.len()).collect::<Vec<_>>(), [2, 1, 1]);
    assert!(tables[2].title.starts_with("All 2 scenes"), "{}", tables[2].title);
}

#[test]
fn ours_and_every_preset_of_obvhs_are_asked() {
    let choices = structures(&Registry::builtin(), "moller-trumbore", ",quality=fast").unwrap();
    assert_eq!(choices.len(), OURS.len() + PRESETS.len() * LAYOUTS.len());
    assert!(choices[1].label.contains("quality=fast"), "{}", choices[1].label);
    assert!(structures(&Registry::builtin(), "no-such-test", "").is_err());
}
