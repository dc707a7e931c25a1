use super::super::means::mean_table as mean_table_of;
use super::*;
use crate::study::measurement::tests::example;

fn record(scene: &str, label: &str, workload: &str, mrays_per_s: Option<f64>) -> Measurement {
    let errors = if mrays_per_s.is_none() { 3 } else { 0 };
    Measurement {
        scene: scene.into(),
        mrays_per_s,
        trace_ns: mrays_per_s.map(|speed| 5e5 / speed),
        samples_ns: mrays_per_s.map_or(vec![], |speed| vec![5e5 / speed; 10]),
        wrong_hits: errors,
        triangle_test: "moller-trumbore".into(),
        ..example(label, workload, &[], 5)
    }
}

fn scene_table(all: &[Measurement], refused: &[&Structure]) -> Table {
    super::scene_table(all, &Reference::of(all, None), refused, true)
}

fn mean_table(all: &[Measurement]) -> Table {
    mean_table_of(all, &Reference::of(all, None))
}

fn cell(table: &Table, row: &str, column: &str) -> String {
    let column = table.columns.iter().position(|c| c == column).unwrap_or_else(|| panic!("no column {column}"));
    let row = table.rows.iter().find(|r| r[0].text() == row).unwrap_or_else(|| panic!("no row {row}"));
    let text = row[column].text();
    let figure = text.split(' ').next().unwrap();
    text.replace(&format!(" [{figure}, {figure}]"), "")
}

fn cube() -> Vec<Measurement> {
    let speeds =
        [("median-kd", [1.0, 2.0]), ("sah-kd", [8.0, 4.0]), ("obvhs-bvh2", [4.0, 1.0]), ("obvhs-cwbvh", [2.0, 4.0])];
    let of = |(label, [primary, random]): (&str, [f64; 2])| {
        [record("A", label, "primary", Some(primary)), record("A", label, "random", Some(random))]
    };
    speeds.map(of).concat()
}

#[test]
fn ratios_are_geometric_means_against_the_tree_and_the_better_bvh() {
    let table = scene_table(&cube(), &[]);
    let cells = ["x median", "x obvhs", "primary", "sampled"].map(|column| cell(&table, "sah-kd", column));
    assert_eq!(cells, ["4.00", "1.41", "~8.00", "50.0 %"]);
    assert_eq!(cell(&table, "median-kd", "x median"), "1.00");
    assert!(!table.columns.iter().any(|column| column == "tests"), "what is unknown of all has no column");
    assert!(legend(&cube(), &[])[0].contains("~: timed on a subset of the rays"));
    let [whole, one_epoch]: [Vec<Measurement>; 2] = [(false, 5), (true, 1)]
        .map(|(sampled, epochs)| cube().into_iter().map(|record| Measurement { sampled, epochs, ..record }).collect());
    assert_eq!(cell(&scene_table(&whole, &[]), "sah-kd", "primary"), "8.00");
    assert!(!legend(&whole, &[])[0].contains('~'));
    let [many, once] = [&cube(), &one_epoch].map(|all| legend(all, &[])[1].contains("interval"));
    assert!(many && !once, "one epoch has no interval");
}

#[test]
fn what_is_declined_is_neither_right_nor_wrong() {
    let mut all = cube();
    all[3] = Measurement { mrays_per_s: None, declined: Some("any hit".into()), wrong_hits: 0, ..all[3].clone() };
    let table = scene_table(&all, &[]);
    assert_eq!(cell(&table, "sah-kd", "random"), "declined");
    assert_eq!(cell(&table, "sah-kd", "x median"), "8.00 (1 of 2)", "of the workloads that it does not decline");
    assert_eq!(table.notes, ["sah-kd declines any hit, which random rays need."]);
    let means = mean_table(&all);
    let note =
        "Missing speeds (one structure on one workload of one scene): 1 because the structure declines the rays.";
    assert_eq!(means.notes[0], note);
    assert_eq!(cell(&means, "sah-kd", "all x median"), "8.00 (1 of 2)");
}

#[test]
fn a_wrong_structure_shows_its_errors_and_no_time_and_a_known_defect_is_named() {
    let mut all = cube();
    for place in [2, 4] {
        (all[place].mrays_per_s, all[place].wrong_hits) = (None, 3);
    }
    let table = scene_table(&all, &[]);
    for (structure, right) in [("sah-kd", "~4.00"), ("obvhs-bvh2", "~1.00")] {
        let shown = ["primary", "x median", "random"].map(|column| cell(&table, structure, column));
        assert_eq!(shown, ["3/100 wrong", "", right]);
    }
    assert_eq!(table.notes.len(), 1);
    assert!(table.notes[0].starts_with("obvhs-bvh2 returns wrong hits on 3 of 100 primary rays"), "{:?}", table.notes);
}

#[test]
fn a_triangle_test_that_misses_what_is_hit_is_named() {
    let mut all = cube();
    for record in &mut all {
        let test = if record.label.starts_with("obvhs") { "rt-triangle" } else { "exact" };
        record.triangle_test = test.into();
    }
    assert!(scene_table(&all, &[]).notes.is_empty());
    all.iter_mut().find(|record| record.label == "obvhs-bvh2").unwrap().counts.hits = 0;
    let notes = scene_table(&all, &[]).notes;
    let expected = "rt-triangle finds hits for 0 of 1,000 primary rays, exact arithmetic for 20";
    assert!(notes.len() == 1 && notes[0].starts_with(expected), "{notes:?}");
}

#[test]
fn what_lies_within_the_noise_is_said_to_be_no_difference() {
    let mut all = cube();
    for (i, record) in all.iter_mut().enumerate() {
        let samples = vec![1e6, 1.01e6, 1e6, 1.01e6, 1e6];
        record.twin_samples_ns = (i < 2).then(|| samples.iter().map(|ns| ns * 1.01).collect());
        (record.samples_ns, record.epochs) = (samples, 5);
        record.mrays_per_s = Some(1.0);
    }
    let table = scene_table(&all, &[]);
    assert_eq!(cell(&table, "sah-kd", "x obvhs"), "1.00 [0.973, 1.03] =", "the same samples");
    all[2].samples_ns = vec![1.01e6, 1e6, 1.01e6, 1e6, 1e6];
    let table = scene_table(&all, &[]);
    assert!(cell(&table, "sah-kd", "x obvhs").ends_with(" ="), "{table:?}");
    let expected = "A/A noise (median-kd built twice and compared with itself): 1.00%; 0 of 2";
    assert!(table.notes[0].starts_with(expected), "{:?}", table.notes);
    // The ratio to the twin varies more between epochs than its mean differs from 1.
    for record in &mut all[..2] {
        let by = [1.02, 0.98, 1.03, 0.98, 1.0];
        let twin = record.samples_ns.iter().zip(by).map(|(ns, by)| ns * by);
        record.twin_samples_ns = Some(twin.collect());
    }
    let note = &scene_table(&all, &[]).notes[0];
    assert!(note.contains("itself): none beyond the variation of the epochs; 2 of 2"), "{note}");
}

#[test]
fn without_the_usual_references_the_first_structure_is_the_reference() {
    let all = [record("A", "sah-kd", "primary", Some(1.0)), record("A", "sah-bvh", "primary", Some(2.0))];
    let table = scene_table(&all, &[]);
    assert!(!table.columns.iter().any(|c| c == "x median" || c == "x obvhs"), "{:?}", table.columns);
    assert_eq!([cell(&table, "sah-bvh", "x sah-kd"), cell(&table, "sah-kd", "x sah-kd")], ["2.00", "1.00"]);
    let named = super::scene_table(&all, &Reference::of(&all, Some("sah-bvh")), &[], true);
    assert_eq!(cell(&named, "sah-kd", "x sah-bvh"), "0.500");
    assert!(legend(&all, &Reference::of(&all, None)).iter().any(|line| line.starts_with("x sah-kd: ")));
}

#[test]
fn a_mean_over_fewer_scenes_names_its_count_and_is_not_ranked() {
    let of = |(scene, fast)| {
        let speeds = [("median-kd", Some(1.0)), ("sah-kd", Some(2.0)), ("sah-bvh", fast)];
        speeds.map(|(label, speed)| record(scene, label, "primary", speed))
    };
    let mut all = [("A", Some(9.0)), ("B", None), ("C", Some(9.0))].map(of).concat();
    let table = mean_table(&all);
    assert_eq!([cell(&table, "sah-kd", "primary"), cell(&table, "sah-bvh", "primary")], ["2.00", "9.00 (2 of 3)"]);
    assert_eq!(cell(&table, "sah-bvh", "all x median"), "9.00 (2 of 3)");
    assert!(table.title.contains("3 scenes") && table.notes[0].ends_with(": 1 because of wrong hits."), "{table:?}");
    // A missing measurement counts as a refusal.
    let mut fewer = all.clone();
    fewer.retain(|r| (&r.scene[..], &r.label[..]) != ("A", "sah-kd"));
    let note = mean_table(&fewer).notes.swap_remove(0);
    assert!(note.ends_with(": 1 because of wrong hits and 1 because the structure is refused on the scene."), "{note}");
    let best = |row: &str| table.rows.iter().find(|r| r[0].text() == row).unwrap()[1].tone;
    assert_eq!((best("sah-kd"), best("sah-bvh")), (Tone::Best, Tone::Plain));
    assert!(table.notes.iter().any(|note| note.starts_with("(n of m)")), "{:?}", table.notes);
    // A scene on which the reference has no time does not count.
    all[0].mrays_per_s = None;
    assert_eq!(cell(&mean_table(&all), "sah-bvh", "primary"), "9.00 (1 of 2)");
    assert!(!mean_table(&all[..1]).has_values());
}

#[test]
fn means_are_those_of_the_scenes_and_their_intervals_of_the_epochs_that_all_have() {
    let mut all = cube();
    for label in ["median-kd", "sah-kd", "obvhs-bvh2"] {
        let speed = if label == "sah-kd" { 8.0 } else { 1.0 };
        let samples_ns = vec![5e5 / speed; 2];
        all.push(Measurement { epochs: 1, samples_ns, ..record("B", label, "primary", Some(speed)) });
    }
    let table = mean_table(&all);
    assert_eq!(cell(&table, "sah-kd", "primary"), "8.00");
    assert!(table.notes.contains(&"Scenes have 1 to 5 epochs: intervals of means use the first of each.".into()));
    assert!(mean_table(&cube()).notes.iter().all(|note| !note.contains("epochs")));
    let whole: Vec<Measurement> = all.into_iter().filter(|record| record.label != "obvhs-cwbvh").collect();
    assert!(mean_table(&whole).notes.iter().all(|note| !note.starts_with("(n of m)")), "no row lacks a case");
}
