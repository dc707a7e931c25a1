mod unlike;

use super::changes::finding;
use super::*;
use crate::measure::Estimate;
use crate::study::measurement::tests::example;

const EPOCHS: usize = 5;

fn record(label: &str, workload: &str, ns: f64) -> Measurement {
    let epoch = |e: usize| 1.0 + 0.002 * (e as f64 - 2.0);
    let samples_ns: Vec<f64> = (0..EPOCHS).flat_map(|e| [ns * epoch(e); 3]).collect();
    example(label, workload, &samples_ns, EPOCHS)
}

fn side(all: Vec<Measurement>) -> Side {
    Side::of(Provenance::capture(1), all, None)
}

fn run(slow: f64, sah: f64) -> Vec<Measurement> {
    let times = [("median-kd", 9e6), ("sah-kd", 2e6 * sah), ("obvhs-bvh2", 2e6), ("obvhs-cwbvh", 1e6)];
    let of = |workload| times.map(|(label, ns)| record(label, workload, ns * slow));
    ["primary", "shadow"].map(of).concat()
}

fn compare(old: &[Measurement], new: &[Measurement], threshold: Option<f64>, looks: usize) -> Comparison {
    Comparison::new(&side(old.to_vec()), &side(new.to_vec()), threshold, looks)
}

fn change_of<'a>(comparison: &'a Comparison, structure: &str) -> &'a Change {
    comparison.structures.iter().find(|change| change.structure == structure).unwrap()
}

#[track_caller]
fn assert_time(comparison: &Comparison, structure: &str, expected: f64) {
    let time = change_of(comparison, structure).time.unwrap();
    assert!((time.estimate - expected).abs() < 1e-9, "{structure}: {time:?}");
}

#[test]
fn times_are_relative_to_the_references() {
    let without_obvhs =
        |run: Vec<Measurement>| run.into_iter().filter(|own| !measurement::is_native_obvhs(own)).collect();
    let with_our_test = |ours: f64| -> Vec<Measurement> {
        let exact = ["primary", "shadow"].map(|workload| record("obvhs-bvh2:test=exact", workload, 3e6 * ours));
        [run(1.0, ours), exact.map(|r| Measurement { structure: "obvhs-bvh2".into(), ..r }).into()].concat()
    };
    let obvhs = &["obvhs-bvh2", "obvhs-cwbvh"][..];
    for (old, new, named, references, expected) in [
        // A slower machine is not a slower structure.
        (run(1.0, 1.0), run(1.5, 1.1), None, obvhs, [("sah-kd", 1.1), ("median-kd", 1.0)]),
        // An obvhs structure with our triangle test is not a reference.
        (with_our_test(1.0), with_our_test(1.2), None, obvhs, [("sah-kd", 1.2), ("obvhs-bvh2:test=exact", 1.2)]),
        (run(1.0, 1.0), run(1.0, 0.5), Some("sah-kd"), &["sah-kd"], [("obvhs-bvh2", 2.0), ("median-kd", 2.0)]),
        // Without references, times are not normalised.
        (without_obvhs(run(1.0, 1.0)), without_obvhs(run(1.5, 1.0)), None, &[], [("sah-kd", 1.5), ("median-kd", 1.5)]),
    ] {
        let [old, new] = [old, new].map(|run| Side::of(Provenance::capture(1), run, named));
        assert_eq!(unlike(&old, &new, !references.is_empty()), Ok(()));
        let comparison = Comparison::new(&old, &new, None, 1);
        assert_eq!(comparison.references, references);
        for (structure, time) in expected {
            assert_time(&comparison, structure, time);
            let finding = if time > 1.0 { Finding::Slower } else { Finding::NoDifference };
            let change = change_of(&comparison, structure);
            assert_eq!((change.finding, change.cells), (finding, 2), "{structure}");
        }
        assert!(comparison.structures.iter().all(|own| !references.contains(&own.structure.as_str())));
        assert!(comparison.wrong.is_empty() && comparison.only_old.is_empty() && comparison.only_new.is_empty());
        let is_told = cautions(&comparison).iter().any(|caution| caution.contains("not normalised"));
        assert_eq!(is_told, references.is_empty());
    }
}

#[test]
fn intervals_decide_the_finding() {
    let interval = |low, high| Some(Estimate::between((low + high) / 2.0, low, high));
    let limit = Some(libm::log(1.05));
    let cases = [
        (interval(1.06, 1.14), limit, Finding::Regression),
        // The estimate 1.08 exceeds the threshold.
        (interval(1.02, 1.14), limit, Finding::Regression),
        (interval(1.01, 1.08), limit, Finding::Inconclusive),
        (interval(0.98, 1.14), limit, Finding::Inconclusive),
        (interval(0.90, 1.14), limit, Finding::Inconclusive),
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
fn changed_hits_are_wrong() {
    let old = run(1.0, 1.0);
    type Edit = dyn Fn(&mut Measurement);
    let changes: [(&str, &Edit); 7] = [
        ("", &|_| {}),
        ("3 of 100 rays have a wrong hit; in the old run 0 of 100", &|r| r.wrong_hits = 3),
        ("19 of 1000 rays hit; in the old run 20", &|r| r.counts.hits = 19),
        ("some hits have another t or primitive than in the old run", &|r| r.hit_checksum = Some(0)),
        // After these changes, the hits are not comparable.
        ("", &|r| (r.counts.rays, r.counts.hits) = (500, 9)),
        ("", &|r| (r.rays, r.hit_checksum) = (250, Some(0))),
        ("", &|r| r.hit_checksum = None),
    ];
    for (i, (what, change)) in changes.into_iter().enumerate() {
        let mut new = old.clone();
        change(&mut new[1]);
        let wrong = compare(&old, &new, None, 1).wrong;
        let found = wrong.iter().map(|wrong| [&wrong.case[..], &wrong.what].join(": "));
        let expected = (!what.is_empty()).then(|| format!("sah-kd on the primary rays of Cube: {what}"));
        assert_eq!(found.collect::<Vec<_>>(), Vec::from_iter(expected), "change {i}");
    }
}

#[test]
fn known_errors_are_no_new_ones() {
    let erring = |i: usize, errors, checked| {
        let mut run = run(1.0, 1.0);
        (run[i].wrong_hits, run[i].checked_rays) = (errors, checked);
        run
    };
    let new_ones = |old: Vec<_>, new: Vec<_>| compare(&old, &new, None, 1).wrong.len();
    assert_eq!(new_ones(erring(1, 2, 100), erring(1, 5, 240)), 0, "more rays, more errors");
    assert_eq!(new_ones(erring(1, 2, 100), erring(1, 5, 100)), 1);
    assert_eq!(new_ones(erring(2, 0, 100), erring(2, 5, 100)), 0, "obvhs has defects");
}

#[test]
fn a_structure_is_compared_with_itself_whatever_its_keys_and_its_test() {
    let old = run(1.0, 1.0);
    let mut new = run(1.0, 1.1);
    for own in new.iter_mut().filter(|own| own.label == "sah-kd") {
        own.label = "sah-kd:leaf=4,test=moller-trumbore".into();
        own.config = serde_json::json!({ "leaf": 4, "threshold": 0.7 });
        (own.triangle_test, own.counts.hits, own.hit_checksum) = ("other".into(), 19, Some(7));
    }
    let (a, b) = (side(old.clone()), side(new.clone()));
    assert_eq!(unlike(&a, &b, true), Ok(()));
    let comparison = Comparison::new(&a, &b, Some(5.0), 1);
    assert_eq!(comparison.differences, ["leaf of sah-kd 8, now 4", "triangle test of sah-kd exact, now other"]);
    assert!(tables(&comparison)[0].title.contains("leaf of sah-kd 8, now 4"));
    assert_time(&comparison, "sah-kd:leaf=4,test=moller-trumbore", 1.1);
    assert_eq!(change_of(&comparison, "sah-kd:leaf=4,test=moller-trumbore").cells, 2);
    assert!(comparison.wrong.is_empty() && comparison.only_old.is_empty(), "another test has other hits");

    // With two structures of one name, the counterpart is ambiguous.
    let ours = new.iter().filter(|own| own.structure == "sah-kd");
    let others: Vec<_> = ours.map(|own| Measurement { label: "sah-kd:leaf=2".into(), ..own.clone() }).collect();
    let comparison = compare(&old, &[new, others].concat(), None, 1);
    assert_eq!((comparison.only_old.len(), comparison.only_new.len()), (2, 4));
}

#[test]
fn a_gate_ends_in_a_sentence_a_structure() {
    for (sah, verdict) in [
        (1.2, "20.0 % slower [20.0, 20.0]: over the limit of 10 %."),
        (1.05, "5.0 % slower [5.0, 5.0]: within the limit of 10 %."),
        (0.8, "20.0 % less time [20.0, 20.0]."),
    ] {
        let found = sentences(&compare(&run(1.0, 1.0), &run(1.0, sah), Some(10.0), 1));
        assert_eq!(found[1], format!("sah-kd: right on 200 checked rays; {verdict}"));
    }
    let mut wrong = run(1.0, 1.0);
    wrong[1].wrong_hits = 3;
    let found = sentences(&compare(&run(1.0, 1.0), &wrong, Some(10.0), 1))[1].clone();
    assert!(found.starts_with("sah-kd: wrong or changed hits in 1 cell;"), "{found}");
    assert!(sentences(&compare(&run(1.0, 1.0), &wrong, None, 1)).is_empty(), "no gate");
}

#[test]
fn what_weighs_most_decides_and_settings_that_differ_are_named() {
    let old = [example("a", "primary", &[1e6; 3], 3), example("b", "primary", &[1e6; 3], 3)];
    let mut new = old.clone();
    new[0].samples_ns.iter_mut().for_each(|ns| *ns *= 2.0);
    let mut comparison = compare(&old, &new, Some(5.0), 1);
    assert_eq!(comparison.status(), Status::Regression);
    comparison.only_old = vec!["c".into()];
    assert_eq!(comparison.status(), Status::Refused);
    comparison.wrong = vec![Wrong { structure: "a".into(), case: "a".into(), what: "lost".into() }];
    assert_eq!(comparison.status(), Status::Wrong);
    assert_eq!(compare(&old, &new, None, 1).status(), Status::Right);
    assert_eq!(compare(&old, &old, Some(5.0), 1).status(), Status::Right);
    new[0].samples_ns = vec![1e6, 2e6, 4e6];
    assert_eq!(compare(&old, &new, Some(5.0), 1).status(), Status::Undecided);

    let case = crate::study::case::tests::example("Cube", 0, &["a"]);
    let mut other = case.clone();
    other.settings.threads = 2;
    assert_eq!(settings(&case, &other), ["threads 1 and 2"]);
    let named = Comparison { settings: settings(&case, &other), ..comparison };
    assert!(cautions(&named).iter().any(|note| note == "Settings differ: threads 1 and 2."));
}

#[test]
fn cases_of_one_run_alone_are_named() {
    let (old, mut new) = (run(1.0, 1.0), run(1.0, 1.0));
    new.remove(1);
    let comparison = compare(&old, &new, None, 1);
    assert_eq!(comparison.only_old, ["sah-kd on the primary rays of Cube"]);
    assert!(comparison.only_new.is_empty());
    assert!(tables(&comparison)[0].notes.iter().any(|note| note.contains("only in the old run")));
    new = run(1.0, 1.0);
    (new[1].samples_ns, new[1].trace_ns) = (vec![], None);
    let comparison = compare(&old, &new, Some(5.0), 1);
    assert_eq!(change_of(&comparison, "sah-kd").finding, Finding::Unknown);
}

#[test]
fn the_aa_noise_of_both_runs_widens_the_interval() {
    let mut old = run(1.0, 1.0);
    let width = |old: &[Measurement]| {
        let time = change_of(&compare(old, &run(1.0, 1.0), None, 1), "sah-kd").time.unwrap();
        libm::log(time.high().unwrap() / time.low().unwrap())
    };
    let before = width(&old);
    let twin = |ns: &f64, by: f64| ns * libm::exp(by);
    for (i, by) in [(0, 0.03), (1, -0.03), (4, 0.03), (5, -0.03)] {
        old[i].twin_samples_ns = Some(old[i].samples_ns.iter().map(|ns| twin(ns, by)).collect());
    }
    // The standard deviation of an A/A ratio is 0.03. A ratio to the mean of two references has 3/4 of the variance of
    // an A/A ratio. The mean over two cells halves the variance. The factor 3.495 is the t quantile for four degrees of
    // freedom, corrected for two structures.
    let alone = 2.0 * 3.495 * 0.03 * libm::sqrt(0.75 / 2.0);
    assert!(before < 1e-9 && (width(&old) / alone - 1.0).abs() < 1e-3, "{before} {} {alone}", width(&old));
}

/// The times of all structures differ only by noise of 1 %.
fn noise(structures: usize, seed: u64) -> Vec<Measurement> {
    let mut random = crate::measure::RandomOrder::new(seed);
    let mut record = |label: &str| {
        let samples_ns: Vec<f64> = (0..8).map(|_| 1e6 * libm::exp(0.01 * random.normal())).collect();
        example(label, "primary", &samples_ns, 8)
    };
    let mut run: Vec<Measurement> = (0..structures).map(|i| record(&format!("own-{i}"))).collect();
    run.push(record("obvhs-bvh2"));
    run
}

#[test]
fn twelve_structures_and_several_looks_do_not_make_a_false_alarm() {
    let alarms = |looks: usize| {
        let alarm = |seed: &u64| {
            let (old, new) = (noise(12, 2 * seed), noise(12, 2 * seed + 1));
            let comparison = compare(&old, &new, Some(1e-6), looks);
            comparison.has(Finding::Regression) || comparison.has(Finding::Faster)
        };
        (0..400).filter(alarm).count() as f64 / 4.0
    };
    // The expected rate of false alarms is at most 5 %.
    assert!(alarms(1) <= 7.0, "{} %", alarms(1));
    assert!(alarms(10) <= 2.0, "{} %", alarms(10));
    let comparison = compare(&noise(12, 1), &noise(12, 2), Some(5.0), 10);
    let note = tables(&comparison)[0].notes[1].clone();
    assert!(note.contains("12 structures and up to 10 looks"), "{note}");
}

#[test]
fn scenes_with_other_numbers_of_epochs_have_a_mean_over_the_first_of_each() {
    let two = |seed: u64| -> Vec<Measurement> {
        let shorter =
            |r: Measurement| Measurement { scene: "B".into(), epochs: 3, samples_ns: r.samples_ns[..3].to_vec(), ..r };
        let run = noise(1, seed);
        run.clone().into_iter().chain(run.into_iter().map(shorter)).collect()
    };
    let comparison = compare(&two(1), &two(2), None, 1);
    let change = change_of(&comparison, "own-0");
    assert!(change.cells == 2 && change.time.unwrap().interval.is_some(), "{change:?}");
    assert_ne!(tables(&comparison)[0].rows[0][2].text(), "not timed");
}

#[test]
fn one_epoch_gives_no_finding() {
    let one = |run: Vec<Measurement>| -> Vec<Measurement> {
        run.into_iter().map(|r| Measurement { epochs: 1, samples_ns: r.samples_ns[..1].to_vec(), ..r }).collect()
    };
    let comparison = compare(&one(run(1.0, 1.0)), &one(run(1.0, 3.0)), Some(5.0), 1);
    let change = change_of(&comparison, "sah-kd");
    assert_eq!((change.finding, change.time.unwrap().interval), (Finding::Unknown, None));
    assert_eq!(tables(&comparison)[0].rows[1][2].text(), "one epoch");
}

#[test]
fn every_key_of_the_export_is_documented() {
    let schema = include_str!("../SCHEMA.md").split("\n## Comparison\n").nth(1).unwrap();
    let mut comparison = compare(&run(1.0, 1.0), &run(1.0, 1.0), Some(5.0), 1);
    comparison.wrong = vec![Wrong { structure: "a".into(), case: "a".into(), what: "lost".into() }];
    let export = serde_json::to_value(&comparison).unwrap();
    let lists = ["structures", "wrong"].map(|list| &export[list][0]);
    let objects = lists.into_iter().chain([&export]);
    let keys = objects.flat_map(|value| value.as_object().unwrap().keys().cloned());
    let findings =
        [Finding::Faster, Finding::NoDifference, Finding::Slower, Finding::Regression, Finding::Inconclusive];
    let words = findings.map(|finding| serde_json::to_value(finding).unwrap().as_str().unwrap().to_owned());
    for word in keys.chain(words) {
        assert!(schema.contains(&format!("`{word}`")), "{word} is not documented");
    }
}
