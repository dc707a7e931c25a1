//! Verdicts on numbers whose truth is known.

use super::*;
use crate::measure::Interval;
use crate::study::attribution;

fn interval(estimate: f64, low: f64, high: f64) -> Interval {
    Interval { estimate, low, high }
}

fn counted(scene: &str, rays: u64, report_rays: u64, tests: Vec<u64>) -> Case {
    Case { scene: scene.into(), triangles: 140, rays, default_rays: rays, report_rays, tests }
}

fn verdict(inputs: &Inputs, number: u8) -> Prediction {
    result(inputs).into_iter().find(|p| p.number == number).unwrap()
}

/// The attribution of a scene whose SAH tree is `whole` times as fast as the report's.
fn attributed(scene: &str, stand_in: bool, whole: f64, plane_alone: f64) -> attribution::Attribution {
    let mut result = attribution::tests::example();
    result.scene = crate::report::words::scene_name(scene, stand_in);
    result.stand_in = stand_in;
    result.time.whole = interval(whole, whole * 0.9, whole * 1.1);
    result.plane_alone = interval(plane_alone, plane_alone * 0.9, plane_alone * 1.1);
    result
}

#[test]
fn nothing_measured_is_said_eight_times_with_the_command() {
    let all = result(&Inputs::default());
    assert_eq!(all.iter().map(|p| p.number).collect::<Vec<_>>(), [1, 2, 3, 4, 5, 6, 7, 8]);
    for p in &all {
        assert_eq!((p.verdict, p.why.as_str()), (Verdict::NotMeasured, ""));
        assert!(p.command.as_ref().unwrap().starts_with("sahara "));
    }
    let table = table(&all);
    assert!(table.title.contains("0 confirmed, 0 refuted, 8 not measured"), "{}", table.title);
    assert!(table.notes[3].contains("To measure it: sahara study scaling"), "{}", table.notes[3]);
}

#[test]
fn an_interval_across_a_bound_is_not_sure() {
    let finding = |low: f64, high: f64| Finding::within("x", interval(3.0, low, high), 2.0, 4.0);
    assert_eq!((finding(2.5, 3.5).holds, finding(2.5, 3.5).sure), (true, true));
    assert_eq!((finding(1.5, 3.5).holds, finding(1.5, 3.5).sure), (true, false));
    let outside = |low: f64, high: f64| Finding::within("x", interval(5.0, low, high), 2.0, 4.0);
    assert_eq!((outside(4.5, 6.0).holds, outside(4.5, 6.0).sure), (false, true));
    assert_eq!((outside(3.5, 6.0).holds, outside(3.5, 6.0).sure), (false, false));
    assert_eq!(outside(1.0, 9.0).expected, "2.00 to 4.00");
}

#[test]
fn a_verdict_is_as_sure_as_what_decides_it() {
    let of = |verdict, findings: &[(f64, f64, f64)]| {
        let within = |&(x, low, high): &(f64, f64, f64)| Finding::within("x", interval(x, low, high), 2.0, 4.0);
        let findings = findings.iter().map(within).collect();
        Prediction { number: 1, claim: String::new(), verdict, findings, why: String::new(), command: None }.words()
    };
    let (inside, barely) = ((3.0, 2.5, 3.5), (3.0, 1.0, 3.5));
    let (outside, hardly) = ((9.0, 8.0, 10.0), (5.0, 3.0, 7.0));
    assert_eq!(of(Verdict::Confirmed, &[inside, inside]), "confirmed");
    assert_eq!(of(Verdict::Confirmed, &[inside, barely]), "confirmed, not surely");
    assert_eq!(of(Verdict::Refuted, &[hardly, outside, barely]), "refuted");
    assert_eq!(of(Verdict::Refuted, &[hardly, inside]), "refuted, not surely");
    assert_eq!(of(Verdict::NotMeasured, &[]), "not measured");
}

#[test]
fn rays_are_counted_to_two_and_the_scene_that_is_off_is_named() {
    let exact = |name: &&str| counted(name, 12, if *name == "Starters" { 50 } else { 13 }, vec![]);
    let right = Inputs { counted: scenes().iter().map(exact).collect(), ..Inputs::default() };
    assert_eq!(verdict(&right, 1).verdict, Verdict::Confirmed);
    let mut part = right.clone();
    part.counted.remove(0);
    let some = verdict(&part, 1);
    assert_eq!((some.verdict, some.findings.len()), (Verdict::NotMeasured, 7));
    let mut wrong = part;
    wrong.counted.push(counted("Cornellbox", 1000, 1029, vec![]));
    let refuted = verdict(&wrong, 1);
    assert_eq!(refuted.verdict, Verdict::Refuted);
    assert!(refuted.why.contains("Cornellbox is -29 rays off"), "{}", refuted.why);
}

#[test]
fn tests_on_a_crowded_scene() {
    let of = |report: u64, other: u64| {
        let case = counted("Infinitycandy", 1000, 1000, vec![report * 140, other * 140]);
        verdict(&Inputs { counted: vec![case], ..Inputs::default() }, 3)
    };
    assert_eq!(of(1000, 1200).verdict, Verdict::Confirmed);
    let refuted = of(1000, 900);
    assert_eq!(refuted.verdict, Verdict::Refuted);
    assert!(refuted.why.contains("with 50 / 0.7 it skips a share of 0.100"), "{}", refuted.why);
}

#[test]
fn the_speedup_must_hold_on_every_scene_and_is_explained_by_counts() {
    let of = |dragon: (f64, f64)| {
        let others = [attributed("Lucy", false, 30.0, 2.0), attributed("Sponza", true, 40.0, 2.0)];
        let attribution = [vec![attributed("Dragon", true, dragon.0, dragon.1)], others.to_vec()].concat();
        verdict(&Inputs { attribution, ..Inputs::default() }, 5)
    };
    assert_eq!(of((25.0, 3.0)).verdict, Verdict::Confirmed);
    let slow = of((6.0, 8.0));
    assert_eq!((slow.verdict, slow.findings.len()), (Verdict::Refuted, 6));
    let parts = ["on Dragon (stand-in) the SAH tree does", "Dragon (stand-in) has 3.00 references"];
    assert!(parts.iter().all(|part| slow.why.contains(part)) && !slow.why.contains("Lucy"), "{}", slow.why);
}

#[test]
fn architecture_is_held_against_scans_of_the_same_kind() {
    let of = |sponza: f64| {
        let attribution = vec![
            attributed("Dragon", true, 10.0, 2.0),
            attributed("Lucy", true, 20.0, 2.0),
            attributed("Sponza", true, sponza, 2.0),
        ];
        verdict(&Inputs { attribution, ..Inputs::default() }, 6)
    };
    assert_eq!(of(40.0).verdict, Verdict::Confirmed);
    let refuted = of(15.0);
    assert_eq!((refuted.verdict, refuted.findings.len()), (Verdict::Refuted, 2));
    // Errors of 10 % each add in squares.
    let first = &refuted.findings[0].value;
    assert!((first.estimate - 1.5).abs() < 1e-12 && (first.high / first.estimate - 1.149).abs() < 0.01, "{first:?}");
    // A real scene is not held against stand-ins.
    let mixed = vec![attributed("Dragon", true, 10.0, 2.0), attributed("Sponza", false, 5.0, 2.0)];
    assert_eq!(verdict(&Inputs { attribution: mixed, ..Inputs::default() }, 6).verdict, Verdict::NotMeasured);
}

#[test]
fn brute_force_must_be_alike_and_the_order_as_expected() {
    let main = |scene: &str, t_prime: f64, improvement: f64| Main {
        scene: scene.into(),
        triangles: 100,
        brute_force: read::Seconds { t_prime: interval(t_prime, t_prime, t_prime) },
        improvement: interval(improvement, improvement * 0.9, improvement * 1.1),
    };
    let of = |cube: f64, teapot: f64| {
        let others = [("Sphere", 28.0), ("Metallic", 21.0), ("Cornellbox", 15.0), ("Starters", 9.0), ("Billards", 6.0)];
        let mut main: Vec<Main> = [("Torus", 29.0), ("Teapot", teapot), ("Infinitycandy", 1.1)]
            .iter()
            .chain(&others)
            .map(|&(scene, improvement)| main(scene, 1e-9, improvement))
            .collect();
        main.push(Main {
            scene: "Cube".into(),
            brute_force: read::Seconds { t_prime: interval(cube, cube, cube) },
            ..main[0].clone()
        });
        main[8].improvement = interval(0.9, 0.8, 1.0);
        verdict(&Inputs { replicated: Some(Replicated { main }), ..Inputs::default() }, 2)
    };
    assert_eq!(of(1.5e-9, 24.0).verdict, Verdict::Confirmed);
    let refuted = of(5e-9, 40.0);
    assert_eq!(refuted.verdict, Verdict::Refuted);
    assert!(
        refuted.why.contains("largest on Cube") && refuted.why.contains("Torus over that of Teapot"),
        "{}",
        refuted.why
    );
}

#[test]
fn cost_ranks_within_a_family_or_does_not() {
    let attribution = vec![attributed("Dragon", true, 10.0, 2.0), attributed("Lucy", true, 10.0, 2.0)];
    let half = verdict(&Inputs { attribution, ..Inputs::default() }, 7);
    assert_eq!((half.verdict, half.findings.len()), (Verdict::NotMeasured, 1));
    assert!(half.why.contains("other families"), "{}", half.why);
}

#[test]
fn a_folder_without_anything_reads_as_nothing_and_a_bad_file_is_one_sentence() {
    let folder = tempfile::tempdir().unwrap();
    assert_eq!(read(folder.path(), 1).unwrap(), Inputs::default());
    std::fs::write(folder.path().join("replicate.json"), "[]").unwrap();
    let error = read(folder.path(), 1).unwrap_err().to_string();
    assert!(error.contains("replicate.json") && error.lines().count() == 1, "{error}");
}
