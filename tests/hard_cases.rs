//! The hard cases as a gate: our structures lose no hit, whatever the triangle test, the tests in `f64` are right on all ranked cases,
//! and the exact test gives the truth.

use rayon::prelude::*;
use sahara::measure::SystemClock;
use sahara::registry::{Choice, Registry};
use sahara::request::known_defect;
use sahara::validate::hard_cases::{Content, Court, HardCase, Rank, Score, ask, catalogue};

/// Rays of a case.
const RAYS: usize = 200;
/// Rays of the cases in which every ray needs thousands of exact decisions.
const FEW: usize = 10;
const LABORIOUS: [&str; 3] = ["duplicates_20000", "fan_apex", "far_1e8"];

/// Tests whose answers are right where rounding to `f32` at the end is all that is lost.
const IN_F64: [&str; 2] = ["moller-trumbore-f64", "edge-f64"];

/// Over these partitions the walk is that of `sah-hybrid`: two tests will do.
const SAME_WALK: [&str; 3] = ["sah-kd-wide", "sah-kd-tight", "sah-bvh"];
const FEW_TESTS: [&str; 2] = ["moller-trumbore", "exact"];

/// Our structures over every test they are offered over.
fn ours() -> Vec<Choice> {
    let mut choices = Registry::builtin().all();
    choices.retain(|choice| {
        let repeats = SAME_WALK.contains(&choice.entry.name.as_str()) && !FEW_TESTS.contains(&choice.triangle_test());
        !repeats && known_defect(&choice.entry.name).is_none()
    });
    choices
}

/// What is wrong with the structures on one case, one line each.
fn faults(case: &HardCase, choices: &[Choice]) -> Vec<String> {
    let rays = if LABORIOUS.contains(&case.name) { FEW } else { RAYS };
    let ranked = matches!(case.rank, Rank::Moderate | Rank::Extreme);
    let mut court = Court::new(case, rays);
    let mut faults = vec![];
    for choice in choices {
        let fault = match ask(case, &choice.subject(), rays, &SystemClock::start()) {
            Err(error) => Some(error.to_string()),
            Ok(answers) => match court.score(choice.triangle_test(), answers).unwrap() {
                Score::Rays(score) => {
                    let lost = score.structure_errors != Some(0) || score.contradictions > 0;
                    let inexact = choice.triangle_test() == "exact" && score.inexact > 0;
                    let wrong = score.judged.missed + score.judged.false_hits + score.judged.wrong_depth;
                    let f64_is_wrong = IN_F64.contains(&choice.triangle_test()) && ranked && wrong > 0;
                    (lost || inexact || f64_is_wrong).then(|| format!("{score:?}"))
                }
                Score::Property(property) => (property.broken > 0).then(|| format!("{property:?}")),
                Score::Failed(failure) => Some(failure.name().into()),
            },
        };
        faults.extend(fault.map(|fault| format!("{} on {}: {fault}", choice.label, case.name)));
    }
    faults
}

#[track_caller]
fn none_of(cases: Vec<&HardCase>) {
    let choices = ours();
    let faults: Vec<String> = cases.into_par_iter().flat_map_iter(|case| faults(case, &choices)).collect();
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

#[test]
fn our_structures_lose_no_hit_on_any_case_with_any_test() {
    none_of(catalogue().into_iter().filter(|case| matches!(case.content, Content::Rays { .. })).collect());
}

#[test]
fn our_structures_have_every_property_with_any_test() {
    none_of(catalogue().into_iter().filter(|case| matches!(case.content, Content::Property(_))).collect());
}
