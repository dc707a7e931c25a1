use super::changes::finding;
use super::*;
use crate::report::timed_example;

const EPOCHS: usize = 5;

/// A case with `ns` a sample in every round, but for what an epoch adds.
fn record(label: &str, workload: &str, ns: f64) -> Record {
    let epoch = |e: usize| 1.0 + 0.002 * (e as f64 - 2.0);
    let samples_ns: Vec<f64> = (0..EPOCHS).flat_map(|e| [ns * epoch(e); 3]).collect();
    timed_example(label, workload, &samples_ns, EPOCHS)
}

/// A run in which the machine is `slow` times as slow and the SAH tree takes `sah` times its time.
fn run(slow: f64, sah: f64) -> Vec<Record> {
    ["primary", "shadow"]
        .into_iter()
        .flat_map(|workload| {
            [
                record("median-kd", workload, 9e6 * slow),
                record("sah-kd", workload, 2e6 * slow * sah),
                record("obvhs-bvh2", workload, 2e6 * slow),
                record("obvhs-cwbvh", workload, 1e6 * slow),
            ]
        })
        .collect()
}

fn change_of<'a>(comparison: &'a Comparison, structure: &str) -> &'a Change {
    comparison.structures.iter().find(|change| change.structure == structure).unwrap()
}

#[test]
fn a_slower_machine_is_no_slower_structure() {
    let comparison = Comparison::new(&run(1.0, 1.0), &run(1.5, 1.1), Some(5.0), 1);
    assert_eq!(comparison.references, ["obvhs-bvh2", "obvhs-cwbvh"]);
    let (median, sah) = (change_of(&comparison, "median-kd"), change_of(&comparison, "sah-kd"));
    assert!((sah.time.unwrap().estimate - 1.1).abs() < 1e-9 && sah.cells == 2);
    assert!((median.time.unwrap().estimate - 1.0).abs() < 1e-9);
    assert_eq!((sah.finding, median.finding), (Finding::Regression, Finding::NoDifference));
    assert_eq!((comparison.structures.len(), comparison.cells.len()), (2, 4), "references are not judged");
    assert!(comparison.wrong.is_empty() && comparison.only_old.is_empty() && comparison.only_new.is_empty());
}

#[test]
fn what_has_our_triangle_test_is_no_reference() {
    let with = |ours: f64| {
        let exact = ["primary", "shadow"].map(|workload| record("obvhs-bvh2:test=exact", workload, 3e6 * ours));
        [run(1.0, ours), exact.map(|r| Record { structure: "obvhs-bvh2".into(), ..r }).into()].concat()
    };
    let comparison = Comparison::new(&with(1.0), &with(1.2), None, 1);
    assert_eq!(comparison.references, ["obvhs-bvh2", "obvhs-cwbvh"]);
    let time = change_of(&comparison, "sah-kd").time.unwrap();
    assert!((time.estimate - 1.2).abs() < 1e-9, "all of our slowdown: {time:?}");
    assert_eq!(change_of(&comparison, "obvhs-bvh2:test=exact").finding, Finding::Slower);
}

#[test]
fn without_references_times_count_as_they_are() {
    let without = |slow: f64| run(slow, 1.0).into_iter().filter(|r| !is_reference(r)).collect::<Vec<_>>();
    let comparison = Comparison::new(&without(1.0), &without(1.5), None, 1);
    assert!(comparison.references.is_empty());
    assert!((change_of(&comparison, "sah-kd").time.unwrap().estimate - 1.5).abs() < 1e-9);
    assert_eq!(change_of(&comparison, "sah-kd").finding, Finding::Slower);
    assert!(tables(&comparison)[0].notes[0].contains("as they are"));
}

#[test]
fn what_an_interval_says() {
    let interval = |low, high| Some(Estimate::between((low + high) / 2.0, low, high));
    let limit = Some(libm::log(1.05));
    let cases = [
        (interval(1.06, 1.14), limit, Finding::Regression),
        (interval(1.02, 1.14), limit, Finding::Undecided),
        (interval(0.90, 1.14), limit, Finding::Undecided),
        (interval(1.01, 1.04), limit, Finding::Slower),
        (interval(0.97, 1.04), limit, Finding::NoDifference),
        (interval(0.90, 0.95), limit, Finding::Faster),
        (interval(1.06, 1.14), None, Finding::Slower),
        (interval(0.90, 1.14), None, Finding::NoDifference),
        (None, limit, Finding::Unknown),
    ];
    for (interval, limit, expected) in cases {
        assert_eq!(finding(interval, limit), expected, "{interval:?}");
    }
}

#[test]
fn answers_that_changed_are_wrong() {
    let old = run(1.0, 1.0);
    let with = |change: &dyn Fn(&mut Record)| {
        let mut new = run(1.0, 1.0);
        change(&mut new[1]);
        Comparison::new(&old, &new, None, 1).wrong
    };
    assert!(with(&|_| {}).is_empty());
    let wrong = with(&|r| r.structure_errors = 3);
    assert_eq!(wrong.len(), 1);
    assert_eq!(
        (&wrong[0].case[..], &wrong[0].what[..]),
        ("sah-kd on the primary rays of Cube", "3 of 100 answers are wrong, 0 of 100 were")
    );
    assert!(with(&|r| r.hits = 19)[0].what.contains("19 of 1000 rays hit, 20 did"));
    assert!(with(&|r| r.answers = Some("0".into()))[0].what.contains("another t"));
    // Other rays have other answers, be they timed or counted, and an unknown answer is none.
    assert!(with(&|r| (r.counted_rays, r.hits) = (500, 9)).is_empty());
    assert!(with(&|r| (r.rays, r.answers) = (250, Some("0".into()))).is_empty());
    assert!(with(&|r| r.answers = None).is_empty());
}

#[test]
fn known_errors_are_no_new_ones() {
    let erring = |i: usize, errors, checked| {
        let mut run = run(1.0, 1.0);
        (run[i].structure_errors, run[i].checked_rays) = (errors, checked);
        run
    };
    let ours = |errors, checked| erring(1, errors, checked);
    assert!(Comparison::new(&ours(2, 100), &ours(5, 240), None, 1).wrong.is_empty(), "more rays, more errors");
    assert_eq!(Comparison::new(&ours(2, 100), &ours(5, 100), None, 1).wrong.len(), 1);
    assert!(Comparison::new(&erring(2, 0, 100), &erring(2, 5, 100), None, 1).wrong.is_empty(), "obvhs has defects");
}

#[test]
fn runs_that_differ_in_more_than_their_code_are_unlike() {
    let old = run(1.0, 1.0);
    let with = |change: &dyn Fn(&mut Record)| {
        let mut new = run(1.0, 1.0);
        new.iter_mut().for_each(change);
        unlike(&old, &new, Machines::Same).map_err(|error| error.to_string())
    };
    assert_eq!(with(&|_| {}), Ok(()));
    assert_eq!(with(&|r| r.provenance.commit = "other".into()), Ok(()));
    type Edit = dyn Fn(&mut Record);
    let refusals: [(&str, &Edit); 10] = [
        ("the processor", &|r| r.provenance.cpu = "Other".into()),
        ("the instruction set", &|r| r.provenance.simd = "portable".into()),
        ("threads is 1 in the old and 2 in the new", &|r| r.provenance.threads = 2),
        ("the profile", &|r| r.provenance.profile = "other".into()),
        ("for the compiler", &|r| r.provenance.target_features = "sse2".into()),
        ("the version of obvhs", &|r| r.provenance.obvhs = "0.5.0".into()),
        ("the hash of the scene Cube", &|r| r.scene_hash = "ff".into()),
        ("the hash of the primary rays of Cube", &|r| r.workload_hash = "ff".into()),
        ("the key threshold of median-kd is 0.7 in the old and 0.8 in the new", &|r| {
            r.config = serde_json::json!({ "leaf": 8, "threshold": 0.8 });
        }),
        ("every case", &|r| r.scene = "Sphere".into()),
    ];
    for (part, change) in refusals {
        let refused = with(change).unwrap_err();
        assert!(refused.contains(part), "{part:?} is not in {refused:?}");
    }
}

#[test]
fn on_two_machines_ratios_to_obvhs_are_compared_and_nothing_else() {
    let elsewhere = |change: &dyn Fn(&mut Record)| {
        let mut new = run(3.0, 1.1);
        let machine = |r: &mut Record| {
            (r.provenance.cpu, r.provenance.simd) = ("Other".into(), "avx2".into());
            (r.provenance.target, r.provenance.target_features) = ("aarch64".into(), "neon".into());
        };
        new.iter_mut().for_each(machine);
        new.iter_mut().for_each(change);
        new
    };
    let (old, new) = (run(1.0, 1.0), elsewhere(&|_| {}));
    assert_eq!(unlike(&old, &new, Machines::Any), Ok(()));
    assert!(unlike(&old, &new, Machines::Same).is_err());
    let comparison = Comparison::new(&old, &new, None, 1);
    assert!((change_of(&comparison, "sah-kd").time.unwrap().estimate - 1.1).abs() < 1e-9);
    assert!(
        tables(&comparison)[0]
            .notes
            .iter()
            .any(|note| note.contains("Two machines, ") && note.contains("Other (avx2)"))
    );
    assert_eq!(Comparison::new(&old, &run(3.0, 1.1), None, 1).machines, None);
    // Another set of lanes on one machine is no other machine.
    let mut other_lanes = run(1.0, 1.1);
    other_lanes.iter_mut().for_each(|r| r.provenance.simd = "others".into());
    let notes = &tables(&Comparison::new(&old, &other_lanes, None, 1))[0].notes;
    assert!(notes.iter().any(|note| note.contains("Two sets of lanes, ")), "{notes:?}");

    // Settings are refused there as well, and so are times without a unit.
    let refused = |new: &[Record]| unlike(&old, new, Machines::Any).unwrap_err().to_string();
    assert!(refused(&elsewhere(&|r| r.provenance.threads = 2)).contains("the number of threads"));
    assert!(refused(&elsewhere(&|r| r.workload_hash = "ff".into())).contains("the primary rays of Cube"));
    assert!(refused(&elsewhere(&|r| r.provenance.obvhs = "0.5.0".into())).contains("the version of obvhs"));
    let untimed = elsewhere(&|r| r.trace_ns = r.trace_ns.filter(|_| !is_reference(r)));
    assert!(
        refused(&untimed).contains("the processor is") && refused(&untimed).contains("ratio to a structure of obvhs")
    );
}

#[test]
fn ratios_are_found_again_or_not() {
    let same = Comparison::new(&run(1.0, 1.0), &run(2.0, 1.0), None, 1).reproduced;
    // In each of two cells: two structures to three bases, less the tree to itself, and the bases among each other.
    assert_eq!((same.ratios, same.old_in_new, same.new_in_old, same.unchanged), (18, 18, 18, 18));
    let other = Comparison::new(&run(1.0, 1.0), &run(1.0, 1.5), None, 1).reproduced;
    assert_eq!((other.ratios, other.old_in_new, other.unchanged), (18, 12, 12), "those of the SAH tree are not");
}

#[test]
fn cases_of_one_run_alone_are_named() {
    let (old, mut new) = (run(1.0, 1.0), run(1.0, 1.0));
    new.remove(1);
    let comparison = Comparison::new(&old, &new, None, 1);
    assert_eq!(comparison.only_old, ["sah-kd on the primary rays of Cube"]);
    assert!(comparison.only_new.is_empty());
    assert!(tables(&comparison)[0].notes.iter().any(|note| note.contains("old run alone")));
    new = run(1.0, 1.0);
    (new[1].samples_ns, new[1].trace_ns) = (vec![], None);
    let comparison = Comparison::new(&old, &new, Some(5.0), 1);
    assert_eq!(change_of(&comparison, "sah-kd").finding, Finding::Unknown);
}

#[test]
fn the_aa_noise_of_both_runs_widens_the_interval() {
    let mut old = run(1.0, 1.0);
    let width = |old: &[Record]| {
        let time = change_of(&Comparison::new(old, &run(1.0, 1.0), None, 1), "sah-kd").time.unwrap();
        libm::log(time.high().unwrap() / time.low().unwrap())
    };
    let before = width(&old);
    let twin = |ns: &f64, by: f64| ns * libm::exp(by);
    for (i, by) in [(0, 0.03), (1, -0.03), (4, 0.03), (5, -0.03)] {
        old[i].twin_samples_ns = Some(old[i].samples_ns.iter().map(|ns| twin(ns, by)).collect());
    }
    // One A/A ratio of four has a noise of 0.03, a structure over the mean of two references 3 / 4 of its square; two
    // cells halve it. Of two structures judged together t is 3.495 with four degrees of freedom, and nothing else
    // varies.
    let alone = 2.0 * 3.495 * 0.03 * libm::sqrt(0.75 / 2.0);
    assert!(before < 1e-9 && (width(&old) / alone - 1.0).abs() < 1e-3, "{before} {} {alone}", width(&old));
}

/// A run of nothing but noise of a hundredth: `structures` of ours and a reference, in eight epochs.
fn noise(structures: usize, seed: u64) -> Vec<Record> {
    let mut random = crate::measure::RandomOrder::new(seed);
    let mut record = |label: &str| {
        let samples_ns: Vec<f64> = (0..8).map(|_| 1e6 * libm::exp(0.01 * random.normal())).collect();
        timed_example(label, "primary", &samples_ns, 8)
    };
    let mut run: Vec<Record> = (0..structures).map(|i| record(&format!("own-{i}"))).collect();
    run.push(record("obvhs-bvh2"));
    run
}

#[test]
fn twelve_structures_and_several_looks_do_not_make_a_false_alarm() {
    let alarms = |looks: usize| {
        let alarm = |seed: &u64| {
            let (old, new) = (noise(12, 2 * seed), noise(12, 2 * seed + 1));
            let comparison = Comparison::new(&old, &new, Some(1e-6), looks);
            comparison.has(Finding::Regression) || comparison.has(Finding::Faster)
        };
        (0..400).filter(alarm).count() as f64 / 4.0
    };
    // Each alone would be wrong in 5 %: of twelve that share a reference about a quarter of all runs.
    assert!(alarms(1) <= 7.0, "{} %", alarms(1));
    assert!(alarms(10) <= 2.0, "{} %", alarms(10));
    let comparison = Comparison::new(&noise(12, 1), &noise(12, 2), Some(5.0), 10);
    let note = &tables(&comparison)[0].notes[1];
    assert!(note.contains("12 structures judged together at up to 10 looks"), "{note}");
}

#[test]
fn scenes_with_other_numbers_of_epochs_have_a_mean_over_the_first_of_each() {
    let two = |seed: u64| -> Vec<Record> {
        let shorter = |r: Record| Record { scene: "B".into(), epochs: 3, samples_ns: r.samples_ns[..3].to_vec(), ..r };
        let run = noise(1, seed);
        run.clone().into_iter().chain(run.into_iter().map(shorter)).collect()
    };
    let comparison = Comparison::new(&two(1), &two(2), None, 1);
    let change = change_of(&comparison, "own-0");
    assert!(change.cells == 2 && change.time.unwrap().interval.is_some(), "{change:?}");
    assert_ne!(tables(&comparison)[0].rows[0][2].text, "no time");
}

#[test]
fn of_one_epoch_nothing_is_found() {
    let one = |run: Vec<Record>| -> Vec<Record> {
        run.into_iter().map(|r| Record { epochs: 1, samples_ns: r.samples_ns[..1].to_vec(), ..r }).collect()
    };
    let comparison = Comparison::new(&one(run(1.0, 1.0)), &one(run(1.0, 3.0)), Some(5.0), 1);
    let change = change_of(&comparison, "sah-kd");
    assert_eq!((change.finding, change.time.unwrap().interval), (Finding::Unknown, None));
    assert_eq!(tables(&comparison)[0].rows[1][2].text, "one epoch");
}
