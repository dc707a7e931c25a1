//! Runs the hard cases.
//!
//! A structure of this crate must cause no error beyond the errors of its triangle test. Triangle tests in `f64` must
//! be right on the moderate and extreme cases. The triangle test `exact` must return the exact hits.

use rayon::prelude::*;
use sahara::measure::SystemClock;
use sahara::registry::{Choice, Registry};
use sahara::request::known_defect;
use sahara::validate::hard_cases::{CaseTruth, Content, HardCase, Rank, catalogue, run};

const RAYS: usize = 200;
/// Rays per case in `LABORIOUS`. Each of these rays needs thousands of exact decisions.
const FEW: usize = 10;
const LABORIOUS: [&str; 3] = ["duplicates_20000", "fan_apex", "far_1e8"];

/// Triangle tests that must have no errors on the moderate and extreme cases.
const IN_F64: [&str; 2] = ["moller-trumbore-f64", "edge-f64"];

/// Structures with the traversal of `sah-hybrid`. These structures run only with the triangle tests in `FEW_TESTS`.
const SAME_TRAVERSAL: [&str; 3] = ["sah-kd-wide", "sah-kd-tight", "sah-bvh"];
const FEW_TESTS: [&str; 2] = ["moller-trumbore", "exact"];

const OF_PEERS: [&str; 2] = ["bvh-triangle", "parry-triangle"];

fn ours() -> Vec<Choice> {
    let mut choices = Registry::builtin().all();
    choices.retain(|choice| {
        let repeats =
            SAME_TRAVERSAL.contains(&choice.entry.name.as_str()) && !FEW_TESTS.contains(&choice.triangle_test());
        !repeats && known_defect(&choice.entry.name).is_none() && !OF_PEERS.contains(&choice.triangle_test())
    });
    choices
}

/// Returns a message if the structure violates a requirement at the top of this file.
fn fault(case: &HardCase, rays: usize, truth: &mut CaseTruth, choice: &Choice) -> Option<String> {
    let test = choice.triangle_test();
    let ranked = matches!(case.rank, Rank::Moderate | Rank::Extreme);
    let answers = match run(case, &choice.subject(), rays, &SystemClock::start()) {
        Ok(answers) => answers,
        Err(error) => return Some(format!("{} on {}: {error}", choice.label, case.name)),
    };
    let score = truth.score(test, answers).unwrap();
    let is_wrong = score.rays().is_some_and(|rays| {
        test == "exact" && rays.inexact > 0 || IN_F64.contains(&test) && ranked && rays.error_counts.errors() > 0
    });
    (is_wrong || !score.is_sound()).then(|| format!("{} on {}: {score:?}", choice.label, case.name))
}

/// If `of_rays` is false, tests the properties instead of the cases with rays. `is_run` receives the indices of a case
/// and a structure.
#[track_caller]
fn assert_sound(of_rays: bool, is_run: fn(usize, usize) -> bool) {
    let (choices, mut cases) = (ours(), catalogue());
    cases.retain(|case| matches!(case.content, Content::Rays { .. }) == of_rays);
    assert!(!of_rays || choices.len() >= STEP && cases.len() >= STEP);
    let of_case = |(index, case): (usize, &HardCase)| {
        let rays = if LABORIOUS.contains(&case.name) { FEW } else { RAYS };
        let mut truth = CaseTruth::new(case, rays);
        let own = choices.iter().enumerate().filter(|(i, _)| is_run(index, *i));
        own.filter_map(|(_, choice)| fault(case, rays, &mut truth, choice)).collect::<Vec<_>>()
    };
    let faults: Vec<String> = cases.into_par_iter().enumerate().flat_map_iter(of_case).collect();
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

/// In the sample, the indices of case and structure are equal modulo `STEP`.
const STEP: usize = 9;

#[test]
fn our_structures_lose_no_hit_on_a_sample_of_cases_and_tests() {
    assert_sound(true, |case, choice| case % STEP == choice % STEP);
}

#[test]
#[ignore = "every case with every structure and test takes half a minute"]
fn our_structures_lose_no_hit_on_any_case_with_any_test() {
    assert_sound(true, |_, _| true);
}

#[test]
fn our_structures_have_every_property_with_any_test() {
    assert_sound(false, |_, _| true);
}
