use super::*;
use crate::measure::Estimate;
use crate::study::epoch::tests::example;

/// Four levels, two epochs of three rounds: 2 ns times n^b, the build 1000 n^c, both with an odd epoch.
fn family(b: f64, c: f64, wobble: f64) -> Vec<FamilyEpoch> {
    let mut cases = vec![];
    for (i, n) in [100usize, 400, 1600, 6400].into_iter().enumerate() {
        for epoch in 0..2 {
            let off = wobble * if (i + epoch) % 2 == 0 { 1.0 } else { -1.0 };
            let at = |scale: f64, power: f64| (scale * libm::pow(n as f64, power) * libm::exp(off)) as u64;
            let ns = at(2e6, b);
            let epoch = example(&format!("sphere {n}"), n, epoch, &[("sah-kd", at(1e6, c), &[ns, ns + 10, ns + 5])]);
            cases.push(FamilyEpoch { family: Family::Spheres, epoch });
        }
    }
    cases
}

#[test]
fn a_power_is_found_where_there_is_one() {
    let growths = result(&family(0.25, 1.1, 0.0));
    assert_eq!(growths.len(), 1);
    let (time, build, bytes) = (growths[0].time.unwrap(), growths[0].build.unwrap(), growths[0].bytes.unwrap());
    assert!((time.estimate - 0.25).abs() < 1e-3 && time.high().unwrap() - time.low().unwrap() < 1e-3, "{time:?}");
    assert!((build.estimate - 1.1).abs() < 1e-3, "{build:?}");
    // 100 bytes a triangle, and counts that do not grow.
    assert!((bytes.estimate - 1.0).abs() < 1e-9);
    assert!(growths[0].tests.unwrap().estimate.abs() < 1e-9);
    assert_eq!(growths[0].points.len(), 4);
    assert!((growths[0].points[0].bytes_per_triangle - 100.0).abs() < 1e-9);
    assert_eq!(ScalingStudy::tables(&growths).len(), 2);
}

#[test]
fn meshes_of_few_epochs_take_none_from_a_claim_about_the_others() {
    let mut cases = family(0.25, 1.0, 0.02);
    let ns = |epoch: usize| (2e6 * libm::pow(4.0 * LEVEL_8 as f64, 0.25)) as u64 + epoch as u64;
    let of = |scene: &str, n: usize, epoch: usize, ns: u64| FamilyEpoch {
        family: Family::Spheres,
        epoch: example(scene, n, epoch, &[("sah-kd", ns, &[ns; 3])]),
    };
    // Four more epochs of the coarser ones, and two of one that is beyond level 8.
    for (i, n) in [100usize, 400, 1600, 6400].into_iter().enumerate() {
        let ns = (2e6 * libm::pow(n as f64, 0.25)) as u64;
        cases.extend((2..6).map(|epoch| of(&format!("sphere {n}"), n, epoch, ns + (i + epoch) as u64 % 2 * 100_000)));
    }
    cases.extend((0..2).map(|epoch| of("finest", 4 * LEVEL_8, epoch, ns(epoch))));
    let growth = &result(&cases)[0];
    let freedom = |estimate: Option<Estimate>| estimate.unwrap().interval.unwrap().freedom;
    assert_eq!((freedom(growth.time_to_level_8), freedom(growth.time)), (5.0, 1.0), "{growth:?}");
}

#[test]
fn noise_widens_the_interval_about_the_true_power() {
    let time = |wobble| result(&family(0.25, 1.0, wobble))[0].time.unwrap();
    let (quiet, noisy) = (time(0.01), time(0.1));
    for interval in [quiet, noisy] {
        assert!(interval.holds(0.25), "{interval:?}");
    }
    assert!(noisy.high().unwrap() - 0.25 > 5.0 * (quiet.high().unwrap() - 0.25), "{quiet:?} {noisy:?}");
}

#[test]
fn a_claim_about_coarser_meshes_is_judged_by_these_alone() {
    let mut cases = family(0.25, 1.0, 0.0);
    let both = |cases: &[FamilyEpoch]| (result(cases)[0].time.unwrap(), result(cases)[0].time_to_level_8.unwrap());
    let (all, coarser) = both(&cases);
    assert_eq!(all, coarser);
    // Beyond level 8 the power is another one.
    for epoch in 0..2 {
        let triangles = 16 * LEVEL_8;
        let ns = 1 << 40;
        let epoch = example("finest", triangles, epoch, &[("sah-kd", 1 << 40, &[ns; 3])]);
        cases.push(FamilyEpoch { family: Family::Spheres, epoch });
    }
    let (all, coarser) = both(&cases);
    assert!((coarser.estimate - 0.25).abs() < 1e-3 && all.estimate > 0.3, "{all:?} {coarser:?}");
}

#[test]
fn a_single_leaf_takes_no_part() {
    let mut cases = family(0.25, 1.0, 0.0);
    for case in cases.iter_mut().filter(|case| case.epoch.triangles == 100) {
        case.epoch.structures[0].shape.leaves = 1;
        // As slow as brute force would be.
        case.epoch.structures[0].rays[0].ns = vec![1 << 50; 3];
    }
    let growth = &result(&cases)[0];
    assert!((growth.time.unwrap().estimate - 0.25).abs() < 1e-3);
    assert_eq!(growth.points.iter().filter(|point| point.fitted).count(), 3);
    // Two are too few.
    cases.retain(|case| case.epoch.triangles != 400);
    let growth = &result(&cases)[0];
    assert_eq!((growth.time, growth.points.len()), (None, 3));
}

#[test]
fn families_and_kinds_of_rays_are_kept_apart() {
    let mut cases = family(0.25, 1.0, 0.0);
    for mut case in family(0.9, 1.0, 0.0) {
        case.family = Family::Meshes;
        let rays = crate::study::epoch::Rays { workload: "random".into(), ..case.epoch.structures[0].rays[0].clone() };
        case.epoch.structures[0].rays.push(rays);
        cases.push(case);
    }
    let growths = result(&cases);
    let of: Vec<_> = growths.iter().map(|g| (g.family, g.workload.as_str())).collect();
    assert_eq!(of, [(Family::Spheres, "primary"), (Family::Meshes, "primary"), (Family::Meshes, "random")]);
    assert!((growths[1].time.unwrap().estimate - 0.9).abs() < 1e-3);
}

#[test]
fn spheres_are_seen_alike() {
    let (coarse, fine) = (sphere(0).unwrap(), sphere(3).unwrap());
    assert_eq!((coarse.mesh.len(), fine.mesh.len()), (20, 1280));
    assert_eq!(coarse.camera, fine.camera);
    // The names of levels are their numbers; the finest has sixteen million.
    assert_eq!((name(0).as_str(), FINEST), ("icosphere 0", 10));
    assert_eq!(sphere(5).unwrap().mesh.len(), 20 << 10);
    assert_eq!([3, 5, FINEST].map(triangles), [1280, 20 << 10, 16_020_500]);
}

#[test]
fn the_finest_is_the_last_one_that_there_is_room_for() {
    assert_eq!(finest(|_| true), FINEST);
    assert_eq!(finest(|triangles| triangles < 16_020_500), FINEST - 1);
    assert_eq!(finest(|_| false), 0);
}
