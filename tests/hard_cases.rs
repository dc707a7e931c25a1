//! The hard cases as a gate: the structures of this crate lose no hit over any triangle test, the tests in `f64` are
//! right on all ranked cases, and the exact test returns the exact hits.

use rayon::prelude::*;
use sahara::measure::SystemClock;
use sahara::registry::{Choice, Registry};
use sahara::request::known_defect;
use sahara::validate::hard_cases::{CaseTruth, Content, HardCase, Rank, catalogue, run};

/// Rays of a case.
const RAYS: usize = 200;
/// Rays of the cases in which every ray needs thousands of exact decisions.
const FEW: usize = 10;
const LABORIOUS: [&str; 3] = ["duplicates_20000", "fan_apex", "far_1e8"];

/// Tests whose hits are right except for the final rounding to `f32`.
const IN_F64: [&str; 2] = ["moller-trumbore-f64", "edge-f64"];

/// These partitions share the traversal of `sah-hybrid`: two tests are enough.
const SAME_WALK: [&str; 3] = ["sah-kd-wide", "sah-kd-tight", "sah-bvh"];
const FEW_TESTS: [&str; 2] = ["moller-trumbore", "exact"];

/// The structures of this crate over every test that they offer.
fn ours() -> Vec<Choice> {
    let mut choices = Registry::builtin().all();
    choices.retain(|choice| {
        let repeats = SAME_WALK.contains(&choice.entry.name.as_str()) && !FEW_TESTS.contains(&choice.triangle_test());
        !repeats && known_defect(&choice.entry.name).is_none()
    });
    choices
}

/// The faults of the structures on one case, one line each.
fn faults<'a>(case: &HardCase, choices: impl IntoIterator<Item = &'a Choice>) -> Vec<String> {
    let rays = if LABORIOUS.contains(&case.name) { FEW } else { RAYS };
    let ranked = matches!(case.rank, Rank::Moderate | Rank::Extreme);
    let mut truth = CaseTruth::new(case, rays);
    let mut faults = vec![];
    for choice in choices {
        let test = choice.triangle_test();
        let fault = match run(case, &choice.subject(), rays, &SystemClock::start()) {
            Err(error) => Some(error.to_string()),
            Ok(answers) => {
                let score = truth.score(test, answers).unwrap();
                let is_wrong = score.rays().is_some_and(|rays| {
                    test == "exact" && rays.inexact > 0 || IN_F64.contains(&test) && ranked && rays.judged.errors() > 0
                });
                (is_wrong || !score.is_sound()).then(|| format!("{score:?}"))
            }
        };
        faults.extend(fault.map(|fault| format!("{} on {}: {fault}", choice.label, case.name)));
    }
    faults
}

/// Runs each of `cases` on the structures for which `is_run` returns true; its arguments are the indices of the case
/// and of the structure.
#[track_caller]
fn none_of(cases: Vec<&HardCase>, is_run: fn(usize, usize) -> bool) {
    let choices = ours();
    let of_case = |(index, case): (usize, &HardCase)| {
        let sample = choices.iter().enumerate().filter(move |(i, _)| is_run(index, *i));
        faults(case, sample.map(|(_, choice)| choice))
    };
    let faults: Vec<String> = cases.into_par_iter().enumerate().flat_map_iter(of_case).collect();
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

fn cases(of_rays: bool) -> Vec<&'static HardCase> {
    catalogue().into_iter().filter(|case| matches!(case.content, Content::Rays { .. }) == of_rays).collect()
}

/// Diagonals of the whole table: every case with some structures, every structure with some cases.
const STEP: usize = 9;

#[test]
fn our_structures_lose_no_hit_on_a_sample_of_cases_and_tests() {
    assert!(ours().len() >= STEP && cases(true).len() >= STEP);
    none_of(cases(true), |case, choice| case % STEP == choice % STEP);
}

#[test]
#[ignore = "every case with every structure and test takes half a minute"]
fn our_structures_lose_no_hit_on_any_case_with_any_test() {
    none_of(cases(true), |_, _| true);
}

#[test]
fn our_structures_have_every_property_with_any_test() {
    none_of(cases(false), |_, _| true);
}
