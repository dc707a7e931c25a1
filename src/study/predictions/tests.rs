//! Verdicts on numbers whose truth is known.

use super::*;
use crate::measure::Estimate;
use crate::report::document::Block;
use crate::study::attribution;

fn interval(estimate: f64, low: f64, high: f64) -> Estimate {
    Estimate::between(estimate, low, high)
}

fn counted(scene: &str, rays: u64, report_rays: u64, tests: Vec<u64>) -> PictureCounts {
    PictureCounts { scene: scene.into(), triangles: 140, rays, default_rays: rays, report_rays, tests }
}

fn prediction(inputs: &Inputs, number: u8) -> Prediction {
    result(inputs).into_iter().find(|p| p.number == number).unwrap()
}

fn verdicts(prediction: &Prediction) -> Vec<Verdict> {
    prediction.claims.iter().map(|claim| claim.verdict).collect()
}

use Verdict::{Confirmed, NotMeasured, Refuted, Undecided};

/// The attribution of a scene whose SAH tree is `whole` times as fast as the report's.
fn attributed(scene: &str, stand_in: bool, whole: f64, plane_alone: f64) -> attribution::Attribution {
    let mut result = attribution::tests::example();
    result.scene = crate::report::words::scene_name(scene, stand_in);
    result.stand_in = stand_in;
    result.time.whole = interval(whole, whole * 0.98, whole * 1.02);
    result.plane_alone = interval(plane_alone, plane_alone * 0.98, plane_alone * 1.02);
    result
}

#[test]
fn nothing_measured_is_said_of_every_claim_with_the_command() {
    let all = result(&Inputs::default());
    assert_eq!(all.iter().map(|p| p.number).collect::<Vec<_>>(), [1, 2, 3, 4, 5, 6, 7, 8]);
    assert_eq!(all.iter().map(|p| p.claims.len()).collect::<Vec<_>>(), [8, 2, 2, 2, 6, 2, 2, 0]);
    for p in &all {
        assert!(verdicts(p).iter().all(|&verdict| verdict == NotMeasured) && p.why.is_empty() && p.figures.is_empty());
        assert!(p.command.starts_with("sahara "));
    }
    let table = table(&all);
    assert!(
        table.title.ends_with(&format!("0 of {CLAIMS} claims confirmed, 0 refuted, 24 not measured")),
        "{}",
        table.title
    );
    assert!(table.notes[4].contains("To measure it: sahara study scaling"), "{}", table.notes[4]);
}

#[test]
fn the_words_are_those_that_were_written_before() {
    // Numbers of the words are those of the claims: none is added, and none is left out.
    let words: Vec<&str> = result(&Inputs::default()).iter().map(|p| p.words).collect();
    let parts = [
        "within 2",
        "factor of 2; improvement order Torus ~ Sphere > Teapot > Metallic > Cornellbox > Starters > Billards > Infinitycandy > Cube",
        "0.9 to 1.3 tests per ray per triangle; setting 50 / 0.7 does MORE tests than brute force",
        "b near 1 on one mesh refined (icosphere levels 0..8, same view); a proper SAH tree: b <= 0.2",
        "at least 20x; of which the plane choice alone (same stop rule, leaf <= 8): 1.2 to 5x",
        "(Sponza) gain more from SAH than evenly tessellated scans (Dragon, Lucy)",
        "trees of one family well, and trees of different families badly",
        "Open on a CPU",
    ];
    assert!(words.iter().zip(parts).all(|(words, part)| words.contains(part)), "{words:?}");
}

#[test]
fn a_claim_is_decided_by_its_whole_interval() {
    let of = |estimate: f64, low: f64, high: f64| {
        Claim::number("x", Some(interval(estimate, low, high)), Bounds::within(0.0, 40.0)).verdict
    };
    // Of an interval with any number of degrees of freedom, that of one among 24 is longer by a half or more.
    assert_eq!((of(20.0, 15.0, 25.0), of(20.0, 5.0, 35.0)), (Confirmed, Undecided));
    assert_eq!((of(60.0, 55.0, 65.0), of(60.0, 45.0, 75.0), of(60.0, 1.0, 99.0)), (Refuted, Undecided, Undecided));
    let alone = Claim::ratio("x", Some(Estimate::alone(3.0)), Bounds::at_least(1.0));
    assert_eq!((alone.verdict, alone.expected.as_str()), (Undecided, "at least 1.00"), "one epoch decides nothing");
    assert_eq!(Claim::ratio("x", None, Bounds::at_most(2.0)).verdict, NotMeasured);
}

#[test]
fn rays_are_counted_to_two_scene_by_scene() {
    let exact = |name: &&str| counted(name, 12, if *name == "Starters" { 50 } else { 13 }, vec![]);
    let right = Inputs { counted: main_scenes().iter().map(exact).collect(), ..Inputs::default() };
    assert_eq!(verdicts(&prediction(&right, 1)), [Confirmed; 8]);
    let mut part = right.clone();
    part.counted.retain(|case| case.scene != "Cornellbox");
    let missing = |p: &Prediction| verdicts(p).iter().filter(|&&verdict| verdict == NotMeasured).count();
    assert_eq!(missing(&prediction(&part, 1)), 1);
    let blocks = section::blocks(&[prediction(&part, 1)], "sahara study predictions");
    let (Block::Table(measured), Block::Note(note)) = (&blocks[0], &blocks[1]) else { panic!("{blocks:?}") };
    assert_eq!((measured.table.rows.len(), note.split(':').next()), (7, Some("1 claim not measured")));
    part.counted.push(counted("Cornellbox", 1000, 1029, vec![]));
    let one_off = prediction(&part, 1);
    let refuted: Vec<&Claim> = one_off.claims.iter().filter(|claim| claim.verdict == Refuted).collect();
    assert!(refuted.len() == 1 && refuted[0].what.starts_with("Cornellbox"), "{refuted:?}");
    assert!(one_off.why.contains("Cornellbox is -29 rays off"), "{}", one_off.why);
    assert_eq!(tally(&[one_off]), "7 of 8 claims confirmed, 1 refuted");
}

#[test]
fn tests_on_a_crowded_scene_are_two_claims() {
    let of = |report: u64, other: u64| {
        let case = counted("Infinitycandy", 1000, 1000, vec![report * 140, other * 140]);
        prediction(&Inputs { counted: vec![case], ..Inputs::default() }, 3)
    };
    assert_eq!(verdicts(&of(1000, 1200)), [Confirmed, Confirmed]);
    assert_eq!(verdicts(&of(1400, 1200)), [Refuted, Confirmed]);
    // As many as brute force are not more.
    assert_eq!(verdicts(&of(1000, 1000)), [Confirmed, Refuted]);
    let refuted = of(1000, 900);
    assert_eq!(verdicts(&refuted), [Confirmed, Refuted]);
    assert!(refuted.why.contains("with 50 / 0.7 it skips a share of 0.100"), "{}", refuted.why);
}

#[test]
fn the_speedup_is_claimed_scene_by_scene_and_explained_by_counts() {
    let of = |dragon: (f64, f64)| {
        let others = [attributed("Lucy", false, 30.0, 2.0), attributed("Sponza", true, 40.0, 2.0)];
        let attribution = [vec![attributed("Dragon", true, dragon.0, dragon.1)], others.to_vec()].concat();
        prediction(&Inputs { attribution, ..Inputs::default() }, 5)
    };
    assert_eq!(verdicts(&of((25.0, 3.0))), [Confirmed; 6]);
    let slow = of((6.0, 8.0));
    assert_eq!(verdicts(&slow), [Refuted, Refuted, Confirmed, Confirmed, Confirmed, Confirmed]);
    let parts = ["On Dragon (stand-in) the SAH tree does", "Dragon (stand-in) has 3.00 references"];
    assert!(parts.iter().all(|part| slow.why.contains(part)) && !slow.why.contains("On Lucy"), "{}", slow.why);
    // What is near a bound is neither.
    assert_eq!(verdicts(&of((20.1, 4.99)))[..2], [Undecided, Undecided]);
    let one = Inputs { attribution: vec![attributed("Lucy", false, 30.0, 2.0)], ..Inputs::default() };
    let one = verdicts(&prediction(&one, 5));
    assert_eq!(one, [NotMeasured, NotMeasured, Confirmed, Confirmed, NotMeasured, NotMeasured]);
    // Of other rays than primary ones nothing was expected.
    let shadow = attribution::Attribution { workload: "shadow".into(), ..attributed("Lucy", false, 3.0, 2.0) };
    let shadow = Inputs { attribution: vec![shadow], ..Inputs::default() };
    assert_eq!(verdicts(&prediction(&shadow, 5)), [NotMeasured; 6]);
}

#[test]
fn architecture_is_held_against_each_scan_of_the_same_kind() {
    let of = |sponza: f64| {
        let attribution = vec![
            attributed("Dragon", true, 10.0, 2.0),
            attributed("Lucy", true, 20.0, 2.0),
            attributed("Sponza", true, sponza, 2.0),
        ];
        prediction(&Inputs { attribution, ..Inputs::default() }, 6)
    };
    assert_eq!(verdicts(&of(40.0)), [Confirmed, Confirmed]);
    assert_eq!(verdicts(&of(15.0)), [Confirmed, Refuted]);
    assert_eq!(verdicts(&of(20.2)), [Confirmed, Undecided]);
    // A real scene is not held against stand-ins.
    let mixed = vec![attributed("Dragon", true, 10.0, 2.0), attributed("Sponza", false, 5.0, 2.0)];
    let mixed = prediction(&Inputs { attribution: mixed, ..Inputs::default() }, 6);
    assert_eq!(verdicts(&mixed), [NotMeasured, NotMeasured]);
}

#[test]
fn brute_force_must_be_alike_and_the_order_as_expected() {
    let main = |scene: &str, t_prime: f64, improvement: f64| Main {
        scene: scene.into(),
        triangles: 100,
        brute_force_t_prime: Estimate::exact(t_prime),
        improvement: interval(improvement, improvement * 0.98, improvement * 1.02),
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
            brute_force_t_prime: Estimate::exact(cube),
            improvement: interval(0.9, 0.89, 0.91),
            ..main[0].clone()
        });
        prediction(&Inputs { replicated: main, ..Inputs::default() }, 2)
    };
    assert_eq!(verdicts(&of(1.5e-9, 24.0)), [Confirmed, Confirmed]);
    // One scene out of place leaves the order well; one that gains nothing does not.
    assert_eq!(verdicts(&of(5e-9, 24.0)), [Refuted, Confirmed]);
    let some = of(1.5e-9, 40.0);
    assert_eq!(verdicts(&some), [Confirmed, Confirmed]);
    assert!(some.why.contains("Torus gains less than Teapot and Sphere gains less than Teapot"), "{}", some.why);
    let worse = of(1.5e-9, 0.1);
    assert_eq!(verdicts(&worse), [Confirmed, Refuted]);
    assert!((worse.claims[1].value.unwrap().estimate - (1.0 - 2.0 * 6.0 / 35.0)).abs() < 1e-12, "{worse:?}");
}

#[test]
fn cost_ranks_within_a_family_or_does_not() {
    let attribution = vec![attributed("Dragon", true, 10.0, 2.0), attributed("Lucy", true, 10.0, 2.0)];
    let half = prediction(&Inputs { attribution, ..Inputs::default() }, 7);
    assert_eq!(verdicts(&half)[1], NotMeasured);
    assert!(half.claims[0].value.is_some() && half.why.contains("Scenes within a family: 2"), "{half:?}");
}

#[test]
fn what_was_called_open_has_figures_and_no_verdict() {
    let member = |layers: u32, ratio: f64| crate::study::crossover::Member {
        layers,
        complexity: f64::from(layers),
        ratio: interval(ratio, ratio * 0.98, ratio * 1.02),
        kd_ns_per_ray: 1.0,
        bvh_ns_per_ray: 1.0,
    };
    let race = Race {
        kd: "sah-kd".into(),
        bvh: "obvhs-bvh2".into(),
        workload: "primary".into(),
        members: vec![member(1, 1.5), member(64, 0.7)],
        crossings: vec![],
        trend: Some(interval(-0.2, -0.25, -0.15)),
    };
    let open = prediction(&Inputs { crossover: vec![race], ..Inputs::default() }, 8);
    assert!(open.claims.is_empty() && open.figures.len() == 2, "{open:?}");
    assert!(open.why.contains("surely overtakes the BVH from the fewest surfaces to the most in 1"), "{}", open.why);
    let table = table(std::slice::from_ref(&open));
    assert!(table.title.contains("0 of 0 claims") && table.rows.iter().all(|row| row[1].text.is_empty()), "{table:?}");
}
