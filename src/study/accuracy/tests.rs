use super::judged::Judged;
use super::*;
use crate::measure::SystemClock;
use crate::report::Art;
use crate::report::plot::Chart;
use crate::study::Measured;
use crate::study::dataset::tests::dataset;
use crate::study::measure::{BuildWatch, Prepared, measure};
use crate::triangle::MollerTrumbore;

fn planned(words: &str) -> anyhow::Result<Plan> {
    let words: Vec<String> = words.split_whitespace().map(String::from).collect();
    plan(&STUDY.matches(&words).unwrap(), &Registry::builtin())
}

fn measured(words: &str) -> Dataset {
    let measured = planned(words).unwrap().cases.into_iter().map(|case| {
        let prepared = Prepared::new(&case, &Registry::builtin(), None).unwrap();
        let epoch = measure(&case, &prepared, &SystemClock::start(), &BuildWatch::default(), &mut |_| ()).unwrap();
        Measured { case, epoch }
    });
    dataset(measured.collect())
}

/// Expected counts with the exact triangle test, then with `moller-trumbore`.
const KNOWN: [(&str, [[u64; 6]; 2]); 2] = [
    ("edge", [[400, 396, 0, 0, 0, 0], [400, 396, 1, 3, 18, 57]]),
    ("grazing", [[400, 351, 0, 0, 0, 0], [400, 351, 7, 4, 129, 8]]),
];

#[test]
fn exact_is_right_and_single_precision_is_not() {
    let dataset =
        measured("torus -w edge -w grazing -s sah-kd -t exact -t moller-trumbore --rays 400 --runs 2 --budget 2");
    let all = judged(&dataset);
    let counted = |own: &Judged| {
        let errors = own.errors;
        [errors.rays, errors.hits, errors.missed, errors.false_hits, errors.wrong_depth, errors.wrong_primitive]
    };
    // The counts are the same on every machine.
    for (of_kind, (kind, expected)) in all.iter().zip(KNOWN) {
        assert_eq!(of_kind.kind, kind);
        for (own, expected) in of_kind.structures.iter().zip(expected) {
            assert_eq!(counted(own), expected, "{kind} {}", own.structure.label);
            assert!(own.ns_per_ray > 0.0 && own.rays.slowest_ns > Some(0) && !own.is_sampled());
        }
        let [exact, rounds] = &of_kind.structures[..] else { panic!("two structures") };
        let tests = [exact, rounds].map(|own| own.structure.triangle_test.as_str());
        assert_eq!(tests, [Exact::NAME, MollerTrumbore::NAME]);
        assert!(exact.errors.ulps.unwrap().max <= 0.5 && rounds.error < rounds.error_bound);
        // The bound for no error in 400 rays is 1 - 0.05^(1 / 400).
        assert!((exact.error_bound - 0.007461).abs() < 1e-6, "{}", exact.error_bound);
        // The other structure has a higher error bound, so it cannot dominate.
        assert!(exact.dominated_by.is_none());
    }
    assert_eq!(all.len(), KNOWN.len());

    let report = report(&dataset, &STUDY.defaults());
    assert!(report.failures.is_empty());
    let keys: Vec<&str> = report.findings.iter().map(|finding| finding.key.as_str()).collect();
    assert_eq!(keys, ["torus-edge", "torus-grazing"]);
    let start = "Torus, 400 edge rays: our structures return no wrong result with the exact triangle test; share of \
                wrong results with other tests: moller-trumbore";
    assert!(report.findings[0].sentence.starts_with(start), "{}", report.findings[0].sentence);
    assert!(report.tables().all(|table| table.of_scene && table.rows.len() == 2 && table.notes.is_empty()));
    assert_eq!((report.tables().count(), report.data.rows.len()), (2, 4));
    assert!(report.tables().chain([&report.data]).all(|t| t.rows.iter().all(|row| row.len() == t.columns.len())));
}

#[test]
fn what_is_refused_or_owes_the_truth_and_errs_fails() {
    let dataset =
        measured("cube -w vertex -s sah-kd:mailbox=true -s brute-force -t exact --rays 100 --runs 2 --budget 1");
    type Change = fn(&mut Measured);
    let changes: [(Change, &[(&str, bool)]); 4] = [
        (|_| (), &[]),
        (|own| own.epoch.structures[0].rays[0].errors.as_mut().unwrap().missed = 1, &[("", true)]),
        // The first structure has a known defect. The triangle test of the second structure is not exact.
        (
            |own| {
                own.epoch.structures[0].name = "bvh".into();
                own.epoch.structures[1].triangle_test = MollerTrumbore::NAME.into();
                let rays = own.epoch.structures.iter_mut().map(|own| &mut own.rays[0]);
                rays.for_each(|rays| rays.errors.as_mut().unwrap().missed = 1);
            },
            &[],
        ),
        (
            |own| {
                own.epoch.structures[1].refused = Some("it panicked".into());
                own.epoch.structures[1].rays.clear();
            },
            &[("brute-force on Cube has no result: it panicked.", false)],
        ),
    ];
    for (change, expected) in changes {
        let mut changed = dataset.clone();
        change(&mut changed.measured[0]);
        let report = report(&changed, &STUDY.defaults());
        let failures: Vec<(&str, bool)> =
            report.failures.iter().map(|own| (own.sentence.as_str(), own.wrong)).collect();
        assert_eq!(failures, expected);
    }
    let mut figures = report(&dataset, &STUDY.defaults()).blocks.into_iter().filter_map(|block| match block {
        Block::Figure(figure) => Some(figure),
        _ => None,
    });
    let figure = figures.next_back().unwrap();
    let Art::Chart(Chart::Scatter(scatter)) = &figure.art else { panic!("{:?}", figure.art) };
    assert_eq!(figure.id, "accuracy-cube-vertex-0");
    assert_eq!(scatter.groups(), ["sah-kd:mailbox=true", "brute-force"]);
    assert!(scatter.points.iter().all(|point| point.is_bound));
}

#[test]
fn brute_force_is_left_out_of_large_meshes_unless_it_is_named() {
    for (words, takes_part, notes) in [
        ("cube", [true].as_slice(), 0),
        ("cube cornellbox -t exact", &[true, false], 1),
        ("cornellbox -s brute-force", &[true], 0),
        ("cornellbox -s sah-kd:mailbox=true", &[false], 0),
    ] {
        let plan = planned(words).unwrap();
        let has_brute = |case: &crate::study::Case| case.structures.iter().any(|own| own.name() == BRUTE_FORCE);
        assert_eq!(plan.cases.iter().map(has_brute).collect::<Vec<_>>(), takes_part, "{words}");
        assert_eq!(plan.notes.len(), notes, "{words}");
        let labels = plan.cases[0].structures.iter().map(|own| &own.spec);
        assert_eq!(each_once(labels).len(), plan.cases[0].structures.len(), "{words}");
    }
    for words in ["cube -t woop", "cube -s sah-kd -t native", "cube --rays all"] {
        assert!(planned(words).is_err(), "{words}");
    }
}
