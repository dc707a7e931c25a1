//! Checks the tables and findings of invented epochs.

use super::*;
use crate::accel::Query;
use crate::measure::Estimate;
use crate::study::dataset::tests::dataset;
use crate::study::epoch::Rays;
use crate::study::epoch::tests::{example, rays};
use crate::study::{Measured, case};

/// The scene has 100 triangles, 1000 closest-hit rays and 500 shadow rays. `roles` contains the nanoseconds per ray of
/// each role. The second round is slow.
fn scene(name: &str, epochs: usize, roles: &[(&str, u64)]) -> Vec<Measured> {
    let one = |number: usize| {
        let ns: Vec<Vec<u64>> = roles.iter().map(|(_, t)| [1000, 1300, 1000].map(|round| round * t).into()).collect();
        let structures: Vec<(&str, u64, &[u64])> =
            roles.iter().zip(&ns).map(|((role, _), ns)| (*role, 2_000_000_000, &ns[..])).collect();
        let mut epoch = example(name, 100, number, &structures);
        for ((structure, (role, _)), ns) in epoch.structures.iter_mut().zip(roles).zip(&ns) {
            structure.role = (*role).into();
            structure.rays.push(Rays { query: Query::Any, all: 500, ns: ns.clone(), ..rays("image-shadow") });
        }
        Measured { case: case::tests::example(name, number, &[]), epoch }
    };
    (0..epochs).map(one).collect()
}

fn hard(name: &str, epochs: usize, [tree, sah, twin]: [u64; 3]) -> Vec<Measured> {
    scene(name, epochs, &[(TREE, tree), (SAH, sah), (TWIN, twin)])
}

fn main(name: &str, improvement: u64) -> Vec<Measured> {
    let roles: Vec<String> = SWEEP.iter().map(|row| row.role()).collect();
    let mut times = vec![(BRUTE, 300 * improvement), (SAH, 10)];
    times.extend(roles.iter().map(String::as_str).zip([110, 120, 130, 140, 300, 150]));
    times.push((TWIN, 300));
    scene(name, 3, &times)
}

fn of(scenes: &[Vec<Measured>]) -> Report {
    report(&dataset(scenes.concat()), &STUDY.defaults())
}

fn value(report: &Report, key: &str) -> Option<Estimate> {
    report.finding(key)?.value
}

#[test]
fn the_conclusion_is_the_mean_of_the_hard_scenes() {
    let scenes = [hard("Dragon", 3, [800, 100, 800]), hard("Lucy", 3, [200, 100, 200])];
    let report = of(&scenes);
    for (key, times) in [("hard", 4.0), ("hard-dragon", 8.0), ("hard-lucy", 2.0)] {
        assert!((value(&report, key).unwrap().estimate - times).abs() < 1e-9, "{key}");
    }
    let sentence = &report.finding("hard").unwrap().sentence;
    assert!(sentence.contains("speedup 8.00 on Dragon and 2.00 on Lucy; geometric mean"), "{sentence}");
    // 1500 rays at 0.8 microseconds per ray.
    let dataset = dataset(scenes.concat());
    let dragon = &replicated(&dataset)[0];
    let (seconds, t_prime) = (dragon.seconds(TREE).unwrap(), dragon.t_prime(TREE).unwrap());
    assert!((seconds.estimate - 1.2e-3).abs() < 1e-9 && (t_prime.estimate - 8e-9).abs() < 1e-15, "{t_prime:?}");
    assert!((dragon.build_s(TREE).unwrap() - 2.0).abs() < 1e-12);
    assert!(report.tables().chain([&report.data]).all(|t| t.rows.iter().all(|row| row.len() == t.columns.len())));
    assert!(of(&[]).blocks.len() == 1 && of(&[]).findings.is_empty(), "nothing is measured");

    // The mean uses only epochs that exist for all hard scenes.
    let cut = of(&[hard("Dragon", 2, [800, 100, 800]), hard("Lucy", 1, [200, 100, 200])]);
    let mean = value(&cut, "hard").unwrap();
    assert!((mean.estimate - 4.0).abs() < 1e-9 && mean.interval.is_none(), "{mean:?}");
}

#[test]
fn what_is_said_of_the_hard_scenes_is_what_was_found() {
    for (times, phrase) in [
        ([800, 100, 800], "faster than"),
        ([100, 800, 100], "more slowly than"),
        ([101, 100, 180], "at a speed that is not distinguishable"),
    ] {
        let report = of(&[hard("Dragon", 3, times)]);
        let sentence = report.sentences().next().unwrap();
        assert!(sentence.starts_with(&format!("The SAH tree traces primary rays {phrase}")), "{sentence}");
    }
    // A twin with a different time widens the interval. Student's t for two degrees of freedom is 4.3027. The factor
    // sqrt(2) accounts for the noise of a rerun.
    let width = |twin: u64| {
        let faster = value(&of(&[hard("Sponza", 3, [800, 100, twin])]), "hard-sponza").unwrap();
        libm::log(faster.high().unwrap() / faster.low().unwrap())
    };
    let expected = 2.0 * 4.3027 * libm::sqrt(2.0) * libm::log(1.05);
    assert!(width(800) < 1e-9 && (width(840) / expected - 1.0).abs() < 1e-4, "{}", width(840));
}

#[test]
fn an_easy_scene_has_its_improvement_its_sweep_and_its_rays() {
    let scene = main("Torus", 3);
    let dataset = dataset(scene.clone());
    let torus = &replicated(&dataset)[0];
    let improvement = torus.improvement().unwrap();
    assert!((improvement.estimate - 3.0).abs() < 1e-9 && improvement.is_above(2.9));
    let seconds = |role: &str| torus.seconds(role).unwrap().estimate;
    assert!((seconds("25 / 0.4") / seconds("100 / 0.7") - 110.0 / 300.0).abs() < 1e-9);
    assert_eq!((torus.total(), torus.rays()), (1500, [1000, 0, 500]));
    let report = of(&[scene]);
    assert_eq!(value(&report, "rays-torus"), Some(Estimate::exact(1500.0 - 309_289.0)));
    assert!(report.tables().chain([&report.data]).all(|t| t.rows.iter().all(|row| row.len() == t.columns.len())));
    assert_eq!(report.verdicts.iter().filter(|verdict| verdict.value.is_some()).count(), 1);
    let of_all_scenes = ["t-prime", "order"].map(|key| value(&report, key));
    assert_eq!(of_all_scenes, [None, None]);
}

#[test]
fn claims_about_all_scenes_are_judged_with_all_scenes() {
    // Cube has the largest gain. All other gains have the expected order.
    let gains = [90, 50, 60, 40, 3, 9, 2, 20, 6];
    let mut scenes: Vec<Vec<Measured>> = MAIN.iter().zip(gains).map(|(row, gain)| main(row.scene, gain)).collect();
    for Measured { epoch, .. } in &mut scenes[6] {
        for (role, tests) in [("100 / 0.7", 75_000), ("50 / 0.7", 180_000)] {
            let own = epoch.structures.iter_mut().find(|own| own.role == role).unwrap();
            own.rays.iter_mut().for_each(|rays| rays.counts.as_mut().unwrap().whole_tests = Some(tests));
        }
    }
    let report = of(&scenes);
    // (2 x 75,000 tests) / (1500 rays x 100 triangles) = 1.0.
    let exact = |x: f64| Some(Estimate::exact(x));
    assert_eq!((value(&report, "crowded"), value(&report, "crowded-50")), (exact(1.0), exact(2.4)));
    assert!((value(&report, "t-prime").unwrap().estimate - 45.0).abs() < 1e-9);
    // All eight pairs with Cube are reversed. The number of compared pairs is 35.
    let order = value(&report, "order").unwrap();
    assert!((order.estimate - (1.0 - 16.0 / 35.0)).abs() < 1e-12, "{order:?}");
    let sentence = &report.finding("order").unwrap().sentence;
    for part in ["Significantly out of this order", "Infinitycandy improves less than Cube"] {
        assert!(sentence.contains(part), "{sentence}");
    }
    assert_eq!(report.verdicts.len(), 12);
    assert!(report.verdicts.iter().all(|verdict| verdict.value.is_some()));
}

#[test]
fn every_scene_has_a_twin_and_what_is_counted_is_named_as_its_structures_are() {
    let registry = Registry::builtin();
    for row in MAIN.iter().chain(&HARD) {
        let structures = structures(&registry, row).unwrap();
        assert_eq!(structures.len(), if row.is_hard() { 3 } else { 3 + SWEEP.len() });
        let spec = |role: &str| structures.iter().find(|own| own.role == role).unwrap().spec.as_str();
        let tree = if row.is_hard() { TREE.to_owned() } else { DEFAULT.role() };
        assert_eq!([spec(TWIN), spec(&tree), spec(SAH)], [REPORT_TREE, REPORT_TREE, SAH_TREE]);
    }
    let plan = (STUDY.plan)(&STUDY.defaults(), &registry).unwrap();
    for case in &plan.cases {
        let spec = |role: &str| case.structures.iter().find(|own| own.role == role).unwrap().spec.as_str();
        let is_crowded = case.scene.name == "Infinitycandy";
        let expected = if is_crowded { vec![spec("100 / 0.7"), spec("50 / 0.7")] } else { vec![] };
        assert_eq!(case.settings.whole_counts, expected);
    }
    assert_eq!(registry.choose(SECONDARY_RAY_STRUCTURE).unwrap().label, SECONDARY_RAY_STRUCTURE);
}
