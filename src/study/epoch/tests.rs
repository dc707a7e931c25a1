use super::*;
use crate::measure::SystemClock;
use crate::registry::Registry;
use crate::scene::{Builtin, WorkloadKind};
use crate::study::Stage;

/// 1000 closest-hit rays of a workload as if they had been counted, not timed.
pub fn rays(workload: &str) -> Rays {
    Rays {
        workload: workload.into(),
        hash: "11".into(),
        query: Query::Closest,
        all: 1000,
        rays: 1000,
        checksum: 1,
        ns: vec![],
        parts: vec![],
        untimed: None,
        wrong: false,
        counts: Some(RayCounts {
            rays: 1000,
            hits: 500,
            distances: 9,
            tests: Some(4000),
            blocks: Some(1000),
            steps: Some(10_000),
        }),
        details: None,
    }
}

/// An epoch as if it had been measured: a structure, its build, and nanoseconds of every round of 1000 rays, on one
/// kind of rays.
pub fn example(scene: &str, triangles: usize, epoch: usize, structures: &[(&str, u64, &[u64])]) -> Epoch {
    let structure = |&(label, build_ns, ns): &(&str, u64, &[u64])| Structure {
        label: label.into(),
        name: label.split(':').next().unwrap().into(),
        refused: None,
        wrong: false,
        outside: None,
        build_ns,
        shape: Shape { bytes: 100 * triangles, leaves: 8, references: 2 * triangles, depth: 3, sah_cost: None },
        rays: vec![Rays { ns: ns.to_vec(), ..rays("primary") }],
        details: None,
    };
    Epoch {
        scene: scene.into(),
        scene_hash: scene.into(),
        stand_in: false,
        triangles,
        degenerate: 0,
        epoch,
        circumstances: None,
        structures: structures.iter().map(structure).collect(),
    }
}

/// Settings for a moment of these structures.
pub fn settings(registry: &Registry, structures: &[&str]) -> Settings {
    let choose = |spec: &&str| registry.choose(spec).unwrap();
    Settings {
        structures: structures.iter().map(choose).collect(),
        guide: choose(&"sah-kd"),
        asked: Asked::Kinds(vec![WorkloadKind::Primary, WorkloadKind::Shadow], 200),
        runs: 2,
        budget_ns: 50_000_000,
        slowest: f64::INFINITY,
        check_tests: crate::study::bench::check::TESTS,
        detailed: false,
        seed: 1,
        threads: Threads::new(1).unwrap(),
    }
}

#[test]
fn epochs_measured_in_any_order_ask_the_same_rays_and_the_first_alone_is_counted() {
    let scene = Builtin::find("torus").unwrap().scene(None).unwrap();
    let (settings, clock) = (settings(&Registry::builtin(), &["median-kd", "sah-bvh"]), SystemClock::start());
    let mut counts = [false; 2];
    let second = measure(&scene, &settings, 1, &clock, &mut |stage| counts[1] |= stage == Stage::Count).unwrap();
    let first = measure(&scene, &settings, 0, &clock, &mut |stage| counts[0] = stage == Stage::Count).unwrap();
    assert_eq!(counts, [true, false], "it says so after the last sample of the first epoch");
    assert_eq!((first.epoch, second.epoch, first.triangles), (0, 1, 2304));
    for (one, other) in first.structures.iter().zip(&second.structures) {
        assert_eq!((one.rays.len(), &one.label, &one.shape), (2, &other.label, &other.shape));
        for (one, other) in one.rays.iter().zip(&other.rays) {
            assert_eq!((one.rays, one.checksum, one.ns.len()), (other.rays, other.checksum, other.ns.len()));
            assert!(one.counts.is_some() && other.counts.is_none());
            assert_eq!((one.all, &one.hash), (other.all, &other.hash));
        }
    }
    let joined = join(vec![second.clone(), first.clone()], |epoch| Some((epoch, 0)), true);
    assert_eq!(joined.cases, [second.clone(), first.clone()]);
    let lines = lines([&second, &first]);
    assert_eq!(lines.len(), 4);
    assert!(lines.iter().all(|line| line.trace.len() == 2 && line.trace[0].len() == 2 && line.tests.is_some()));
    // Both trees are over one triangle test, and find the same distances.
    first.is_whole().unwrap();
    let mut other = first.clone();
    other.structures[1].rays[0].counts.as_mut().unwrap().distances ^= 1;
    let error = other.is_whole().unwrap_err();
    assert!(error.is_wrong_answer() && error.to_string().contains("median-kd and sah-bvh"), "{error}");
    other.structures[1].rays[0].untimed = Some("it was late".into());
    let error = other.is_whole().unwrap_err();
    assert!(!error.is_wrong_answer() && error.to_string().contains("has no time: it was late"), "{error}");
    // It reads back as it was written.
    let text = serde_json::to_string(&first).unwrap();
    assert_eq!(serde_json::from_str::<Epoch>(&text).unwrap(), first);
}

#[test]
fn what_lacks_a_time_in_an_epoch_has_no_line() {
    let mut epochs =
        [0, 1].map(|epoch| example("a", 10, epoch, &[("x", 5000, &[1000, 3000, 2000]), ("y", 100, &[500; 3])]));
    let both = lines(&epochs);
    assert_eq!(both.len(), 2);
    assert!((both[0].ns_per_ray() - 2.0).abs() < 1e-12 && (both[0].build_ns() - 5000.0).abs() < 1e-9);
    let ratio = both[0].log_ratios(&both[1]).unwrap();
    assert!(middles(&ratio).iter().all(|log| (libm::exp(*log) - 4.0).abs() < 1e-12));
    epochs[1].structures[0].refused = Some("it fell over".into());
    assert_eq!(lines(&epochs).iter().map(|line| line.structure.as_str()).collect::<Vec<_>>(), ["y"]);
}

#[test]
fn a_slow_structure_does_not_change_what_a_ray_costs_another() {
    const ALL: usize = 1 << 18;
    let mut epoch = example("a", 10, 0, &[("x", 50, &[10 * ALL as u64; 3]), ("y", 10, &[64 * 300; 3])]);
    let x = &mut epoch.structures[0].rays[0];
    (x.all, x.rays, x.parts) = (ALL, ALL, vec![Part { rays: 64, ns: vec![64 * 30; 3] }]);
    let y = &mut epoch.structures[1].rays[0];
    (y.all, y.rays) = (ALL, 64);
    let lines = lines([&epoch]);
    assert!((lines[0].ns_per_ray() - 10.0).abs() < 1e-9 && (lines[1].ns_per_ray() - 300.0).abs() < 1e-9, "{lines:?}");
    // The two are compared on the rays of the slow one.
    let ratio = lines[1].log_ratios(&lines[0]).unwrap();
    assert!(middles(&ratio).iter().all(|log| (libm::exp(*log) - 10.0).abs() < 1e-9), "{ratio:?}");
}

#[test]
fn a_structure_that_stands_twice_is_its_own_twin_and_has_one_line() {
    // The twin takes a tenth longer in every epoch, and its build twice as long.
    let structures = |e: u64| [("x", 100, [1000 + e, 2000]), ("y", 100, [500, 500]), ("x", 200, [1100 + e, 2200])];
    let epochs = [0, 1, 2].map(|epoch| {
        let of = structures(epoch as u64);
        let of: Vec<(&str, u64, &[u64])> = of.iter().map(|(label, build, ns)| (*label, *build, &ns[..])).collect();
        example("a", 10, epoch, &of)
    });
    let names: Vec<String> = lines(&epochs).into_iter().map(|line| line.structure).collect();
    assert_eq!(names, ["x", "y"]);
    let twins = twins(&epochs);
    assert!((twins.trace.log().unwrap() - libm::log(1.1)).abs() < 1e-3, "{twins:?}");
    assert!((twins.build.log().unwrap() - libm::log(2.0)).abs() < 1e-9, "{twins:?}");
    assert_eq!(super::twins(&epochs[..0]), Twins::default());
    // Without a time in one epoch there is no pair.
    let mut part = epochs.clone();
    part[1].structures[2].rays[0].ns.clear();
    assert_eq!(super::twins(&part).trace.log(), None);
}
