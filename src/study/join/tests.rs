use super::*;
use crate::measure::SubsetSamples;
use crate::study::case::tests::example as case;
use crate::study::epoch::Structure;
use crate::study::epoch::tests::{example, rays};

fn epochs(scene: &str, numbers: &[usize]) -> Vec<Epoch> {
    numbers.iter().map(|&n| example(scene, 10, n, &[("x", 50, &[1000; 3]), ("y", 10, &[500; 3])])).collect()
}

fn joined_as(epochs: Vec<Epoch>, whole: bool) -> (Vec<Epoch>, JoinedEpochs) {
    let measured = |epoch: Epoch| {
        let mut case = case(&epoch.scene, epoch.epoch, &[]);
        (case.epochs, case.settings.whole) = (3, whole);
        Measured { case, epoch }
    };
    let mut joined = join(epochs.into_iter().map(measured).collect());
    (std::mem::take(&mut joined.measured).into_iter().map(|own| own.epoch).collect(), joined)
}

fn joined(epochs: Vec<Epoch>) -> (Vec<Epoch>, JoinedEpochs) {
    joined_as(epochs, false)
}

fn failure(change: impl Fn(&mut Epoch)) -> StudyError {
    let mut epochs = epochs("a", &[0, 1]);
    change(&mut epochs[1]);
    let (cases, JoinedEpochs { mut failures, .. }) = joined(epochs);
    assert!(cases.is_empty() && failures.len() == 1, "{failures:?}");
    failures.remove(0)
}

#[test]
fn epochs_need_no_order_and_come_out_as_they_came_in() {
    let given = [epochs("a", &[2, 0]), epochs("b", &[1, 0, 2]), epochs("a", &[1])].concat();
    let (cases, JoinedEpochs { failures, unchecked, .. }) = joined(given.clone());
    assert_eq!(cases, given);
    assert!(failures.is_empty() && unchecked.is_empty());
}

#[test]
fn a_scene_without_its_first_epoch_is_left_out_and_one_without_another_is_named() {
    let given = [epochs("a", &[1, 2]), epochs("b", &[0, 2]), epochs("c", &[0, 1, 2])].concat();
    let (cases, JoinedEpochs { unchecked, missing, .. }) = joined(given);
    assert!(cases.len() == 5 && cases.iter().all(|epoch| epoch.scene != "a"));
    assert_eq!(unchecked, ["a: epoch 0 is not measured; epoch 0 checks the hits, so the scene is left out."]);
    assert_eq!(missing, ["b: epoch 1 is not measured."]);
}

#[test]
fn what_the_first_epoch_found_wrong_has_no_time_anywhere() {
    let mut given = epochs("a", &[1, 0]);
    let wrong = &mut given[1].structures[0].rays[0];
    (wrong.untimed, wrong.wrong, wrong.ns) = (Some("3 wrong hits on 9 rays".into()), true, vec![]);
    let (cases, _) = joined(given.clone());
    let one = &cases[0].structures[0].rays[0];
    assert!(one.ns.is_empty() && one.wrong && one.untimed.as_deref() == Some("3 wrong hits on 9 rays"));
    assert_eq!(cases[0].structures[1], given[0].structures[1]);
    // `whole` drops a scene if one of its structures has no time.
    let (cases, JoinedEpochs { failures, .. }) = joined_as(given, true);
    assert!(cases.is_empty() && failures[0].is_wrong_hit(), "{failures:?}");
}

#[test]
fn structures_over_the_exact_test_that_answer_otherwise_are_a_wrong_answer() {
    type Change = ([&'static str; 2], fn(&mut Structure), bool);
    let changes: [Change; 6] = [
        (["exact", "exact"], |_| (), true),
        // Only structures with the exact triangle test are compared.
        (["exact", "moller-trumbore"], |_| (), false),
        (["moller-trumbore", "moller-trumbore"], |_| (), false),
        // `obvhs-bvh2` has known defects, so its hits are not compared.
        (["exact", "exact"], |own| own.name = "obvhs-bvh2".into(), false),
        (["exact", "exact"], |own| own.rays[0].untimed = Some("3 wrong hits on 9 rays".into()), false),
        (["exact", "exact"], |own| own.rays[0].counts.as_mut().unwrap().rays = 10, false),
    ];
    for (i, (tests, change, is_wrong)) in changes.into_iter().enumerate() {
        let mut given = epochs("a", &[0, 1]);
        for (structure, test) in given[0].structures.iter_mut().zip(tests) {
            structure.triangle_test = test.into();
        }
        let other = &mut given[0].structures[1];
        other.rays[0].counts.as_mut().unwrap().distances = 10;
        change(other);
        let failures = joined(given).1.failures;
        let is_named = |error: &StudyError| error.to_string().starts_with("x and y, with the same triangle test");
        assert!(failures.iter().all(|error| error.is_wrong_hit() && is_named(error)), "{i}: {failures:?}");
        assert_eq!(failures.len(), usize::from(is_wrong), "{i}: {failures:?}");
    }
}

#[test]
fn what_is_refused_in_one_epoch_is_refused_in_all() {
    let mut given = epochs("a", &[0, 1, 2]);
    (given[1].structures[1].refused, given[1].structures[1].wrong) = (Some("it fell over".into()), true);
    let (cases, _) = joined(given);
    assert!(cases.iter().all(|epoch| epoch.structures[1].refused.as_deref() == Some("it fell over")));
    assert!(cases.iter().all(|epoch| epoch.structures[1].wrong));
    assert!(cases.iter().all(|epoch| epoch.structures[0].refused.is_none()));
}

#[test]
fn epochs_that_differ_in_what_they_must_not_are_named() {
    let answers = failure(|epoch| epoch.structures[1].rays[0].checksum = 2);
    let sentence = answers.to_string();
    assert!(sentence.contains("y on a, primary rays") && sentence.contains("epochs 0 and 1"), "{sentence}");
    assert!(sentence.contains("the hits") && answers.is_wrong_hit(), "{sentence}");
    for (other, what) in [
        (failure(|epoch| epoch.structures[1].rays[0].hash = "12".into()), "differ in the rays"),
        (failure(|epoch| epoch.structures[1].rays[0].rays = 250), "the number of timed rays"),
        (failure(|epoch| epoch.structures[1].rays[0].ns.truncate(2)), "the number of samples"),
        (failure(|epoch| epoch.structures[1].label = "z".into()), "the structures"),
    ] {
        assert!(other.to_string().contains(what) && !other.is_wrong_hit(), "{other}");
    }
}

#[test]
fn a_structure_of_others_that_answers_otherwise_takes_no_part() {
    let mut given = epochs("a", &[0, 1]);
    given.iter_mut().for_each(|epoch| epoch.structures[1].name = "embree".into());
    given[1].structures[1].rays[0].checksum = 2;
    let (cases, JoinedEpochs { failures, .. }) = joined(given);
    assert!(failures.is_empty(), "{failures:?}");
    for epoch in cases {
        let refused: Vec<Option<&str>> = epoch.structures.iter().map(|s| s.refused.as_deref()).collect();
        assert_eq!(refused, [None, Some(CHANGED)]);
    }
}

#[test]
fn scenes_of_other_labels_are_joined_each_by_itself() {
    let mut given: Vec<Measured> = vec![];
    for label in ["1", "2"] {
        for mut epoch in epochs("a", &[0, 1]) {
            epoch.structures[0].rays[0].rays = if label == "1" { 1000 } else { 250 };
            let mut case = case("a", epoch.epoch, &[]);
            case.labels.insert("threads".into(), label.into());
            given.push(Measured { case, epoch });
        }
    }
    assert_eq!(join(given.clone()).measured, given);
}

#[test]
fn a_program_whose_clock_chose_otherwise_is_timed_on_the_rays_that_all_epochs_have() {
    let program = |number: usize, counts: &[usize]| {
        let mut epoch = example("a", 10, number, &[("p", 50, &[1000]), ("y", 10, &[500])]);
        let parts =
            |from: usize| counts[from..].iter().map(|&rays| SubsetSamples { rays, ns: vec![rays as u64] }).collect();
        let ns = vec![counts[0] as u64];
        epoch.structures[0].name = RUNNER.into();
        epoch.structures[0].rays = vec![Rays { ns, parts: parts(1), rays: counts[0], ..rays("primary") }];
        epoch.structures[1].rays[0].parts = parts(0);
        epoch
    };
    let (cases, JoinedEpochs { failures, .. }) = joined(vec![program(0, &[400, 100]), program(1, &[100, 25])]);
    assert!(failures.is_empty());
    for epoch in &cases {
        let [one, other] = [0, 1].map(|place| &epoch.structures[place].rays[0]);
        assert_eq!((one.rays, &one.ns, one.parts.len()), (100, &vec![100], 0), "{one:?}");
        assert_eq!(other.parts.iter().map(|part| part.rays).collect::<Vec<_>>(), [100]);
    }
    let (cases, _) = joined(vec![program(0, &[400, 100]), program(1, &[25, 6])]);
    assert!(cases.iter().all(|epoch| epoch.structures[0].refused.as_deref() == Some(UNSTEADY)));
    let mut other = program(1, &[400, 100]);
    other.structures[0].rays[0].checksum = 2;
    let (cases, _) = joined(vec![program(0, &[400, 100]), other]);
    assert!(cases.iter().all(|epoch| epoch.structures[0].refused.as_deref() == Some(CHANGED)));
}
