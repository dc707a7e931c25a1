use super::growth::{Growth, LEVEL_8};
use super::*;
use crate::study::Measured;
use crate::study::case::tests::example as case;
use crate::study::dataset::tests::dataset;
use crate::study::epoch::Rays;
use crate::study::epoch::tests::example;

fn measured(family: &str, n: usize, epoch: usize, build_ns: u64, ns: &[u64]) -> Measured {
    let scene = format!("mesh {n}");
    let mut case = case(&scene, epoch, &["sah-kd"]);
    case.labels.insert(FAMILY.into(), family.into());
    Measured { case, epoch: example(&scene, n, epoch, &[("sah-kd", build_ns, ns)]) }
}

const TRIANGLES: [usize; 4] = [100, 400, 1600, 6400];

/// A ray takes 2 us x n^b. A build takes 1 ms x n^c. Each ln(duration) deviates by +`wobble` or -`wobble`.
fn spheres(b: f64, c: f64, wobble: f64) -> Vec<Measured> {
    let mut all = vec![];
    for (i, n) in TRIANGLES.into_iter().enumerate() {
        for epoch in 0..2 {
            let off = wobble * if (i + epoch) % 2 == 0 { 1.0 } else { -1.0 };
            let at = |scale: f64, power: f64| (scale * libm::pow(n as f64, power) * libm::exp(off)) as u64;
            let ns = at(2e6, b);
            all.push(measured(SPHERES, n, epoch, at(1e6, c), &[ns, ns + 10, ns + 5]));
        }
    }
    all
}

fn finest_of(triangles: usize, ns: u64) -> impl Iterator<Item = Measured> {
    (0..2).map(move |epoch| measured(SPHERES, triangles, epoch, ns, &[ns + epoch as u64; 3]))
}

fn one(measured: Vec<Measured>) -> Growth {
    growths(&dataset(measured)).remove(0)
}

#[test]
fn a_power_is_found_where_there_is_one() {
    let growth = one(spheres(0.25, 1.1, 0.0));
    let (time, build, bytes) = (growth.time.unwrap(), growth.build.unwrap(), growth.bytes.unwrap());
    assert!((time.estimate - 0.25).abs() < 1e-3 && time.high().unwrap() - time.low().unwrap() < 1e-3, "{time:?}");
    assert!((build.estimate - 1.1).abs() < 1e-3, "{build:?}");
    let noisy = one(spheres(0.25, 1.1, 0.1)).time.unwrap();
    assert!(noisy.holds(0.25) && noisy.high().unwrap() - noisy.low().unwrap() > 0.01, "{noisy:?}");
    // Memory is 100 bytes per triangle. Counts are equal on all meshes.
    assert!((bytes.estimate - 1.0).abs() < 1e-9);
    assert!(growth.tests.unwrap().estimate.abs() < 1e-9);
    assert!((growth.points[0].bytes_per_triangle() - 100.0).abs() < 1e-9);
}

#[test]
fn the_report_has_the_sentence_three_figures_and_a_row_for_every_point() {
    let report = |measured| super::report(&dataset(measured), &STUDY.defaults());
    let own = report(spheres(0.25, 1.0, 0.01));
    let sentence = &own.finding("spheres").unwrap().sentence;
    assert!(sentence.starts_with("On spheres of n triangles the time of a primary ray grows like n^0.25 ["));
    assert!(sentence.ends_with("] with sah-kd (100 to 6,400 triangles)."), "{sentence}");
    let figures = own.blocks.iter().filter(|block| matches!(block, crate::report::Block::Figure(_)));
    assert_eq!((figures.count(), own.tables().count(), own.data.rows.len()), (3, 1, TRIANGLES.len()));
    assert!(own.verdicts.is_empty() && own.finding("growth-sah").is_none(), "level 8 is missing");
    let mut fine = spheres(0.25, 1.0, 0.01);
    fine.extend(finest_of(LEVEL_8, 2e6 as u64));
    let fine = report(fine);
    assert!(fine.finding("growth-sah").unwrap().value.is_some() && fine.finding("growth-report").is_none());
    assert_eq!(fine.verdicts.len(), 2);
    assert!(report(vec![]).blocks.is_empty());
}

#[test]
fn a_claim_about_coarser_meshes_is_judged_by_these_alone_in_all_of_their_epochs() {
    let mut measured = spheres(0.25, 1.0, 0.02);
    let growth = one(measured.clone());
    assert_eq!(growth.time, growth.time_to_level_8);
    // Each mesh of `TRIANGLES` gets four more epochs. A mesh finer than level 8 gets two epochs.
    for (i, n) in TRIANGLES.into_iter().enumerate() {
        let ns = (2e6 * libm::pow(n as f64, 0.25)) as u64;
        let of = |epoch: usize| ns + (i + epoch) as u64 % 2 * 100_000;
        measured.extend((2..6).map(|epoch| super::tests::measured(SPHERES, n, epoch, of(epoch), &[of(epoch); 3])));
    }
    measured.extend(finest_of(16 * LEVEL_8, 1 << 40));
    let growth = one(measured);
    let [all, coarser] = [growth.time, growth.time_to_level_8].map(Option::unwrap);
    assert!((coarser.estimate - 0.25).abs() < 0.02 && all.estimate > 0.3, "{all:?} {coarser:?}");
    assert_eq!([coarser, all].map(|estimate| estimate.interval.unwrap().freedom), [5.0, 1.0], "{growth:?}");
}

#[test]
fn a_single_leaf_is_not_fitted() {
    let mut measured = spheres(0.25, 1.0, 0.0);
    for own in measured.iter_mut().filter(|own| own.epoch.triangles == 100) {
        own.epoch.structures[0].shape.leaves = 1;
        own.epoch.structures[0].rays[0].ns = vec![1 << 50; 3];
    }
    let growth = one(measured.clone());
    assert!((growth.time.unwrap().estimate - 0.25).abs() < 1e-3);
    assert_eq!(growth.points.iter().filter(|point| point.is_fitted()).count(), 3);
    // Two fitted meshes are too few for an exponent.
    measured.retain(|own| own.epoch.triangles != 400);
    let growth = one(measured);
    assert_eq!((growth.time, growth.points.len()), (None, 3));
}

#[test]
fn families_and_workloads_are_kept_apart() {
    let mut measured = spheres(0.25, 1.0, 0.0);
    for mut own in spheres(0.9, 1.0, 0.0) {
        own.case.labels.insert(FAMILY.into(), MESHES.into());
        let rays = Rays { workload: "random".into(), ..own.epoch.structures[0].rays[0].clone() };
        own.epoch.structures[0].rays.push(rays);
        measured.push(own);
    }
    let growths = growths(&dataset(measured));
    let of: Vec<_> = growths.iter().map(|g| (g.family, g.workload.as_str())).collect();
    assert_eq!(of, [(SPHERES, "primary"), (MESHES, "primary"), (MESHES, "random")]);
    assert!((growths[1].time.unwrap().estimate - 0.9).abs() < 1e-3);
}

#[test]
fn a_plan_labels_spheres_with_their_level_and_meshes_with_their_family() {
    let words = ["torus", "--finest", "2", "--epochs", "2", "-s", "sah-kd"].map(String::from);
    let plan = (STUDY.plan)(&STUDY.matches(&words).unwrap(), &Registry::builtin()).unwrap();
    let keys: Vec<String> = plan.cases[..4].iter().map(|case| case.key()).collect();
    assert_eq!(keys[2..], ["icosphere 2 family=icospheres level=2 epoch 0", "Torus family=meshes epoch 0"]);
    assert_eq!((plan.cases.len(), &plan.cases[0].scene.word), (8, &"icosphere:0".into()));
    assert!(plan.cases.iter().all(|case| case.structures.len() == 2 && case.settings.slowest == Some(SLOWEST)));
}
