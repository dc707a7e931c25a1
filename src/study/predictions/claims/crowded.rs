//! Does a tree help where all triangles crowd in one place?

use super::prediction;
use crate::report::number::figures;
use crate::study::predictions::counted::{CROWDED, TREES};
use crate::study::predictions::{Finding, Inputs, Prediction};

pub(super) fn crowded(inputs: &Inputs) -> Prediction {
    let claim = "On Infinitycandy the report's tree does 0.9 to 1.3 tests per ray and triangle, and its setting 50 / 0.7 more than brute force.";
    let case = inputs.counted.iter().find(|case| case.scene == CROWDED && case.tests.len() == TREES.len());
    let Some(case) = case else {
        return prediction(3, claim, vec![], false, String::new(), "sahara study predictions");
    };
    let share = |tests: u64| tests as f64 / (case.rays as f64 * case.triangles as f64);
    let [report, other] = [share(case.tests[0]), share(case.tests[1])];
    let findings = vec![
        Finding::exact("100 / 0.7: tests per ray and triangle", report, 0.9, 1.3),
        Finding::exact("50 / 0.7: tests per ray and triangle", other, 1.0, f64::INFINITY),
    ];
    let against = |share: f64| match share {
        share if share < 1.0 => format!("skips a share of {} of the tests of brute force", figures(1.0 - share)),
        share => format!("does {} times the tests of brute force", figures(share)),
    };
    let why = format!(
        "A triangle on both sides of a plane is tested again by a ray that passes both cells; a hit ends the search as soon as nothing nearer can \
         follow. Together, with the default the tree {}, with 50 / 0.7 it {}.",
        against(report),
        against(other)
    );
    prediction(3, claim, findings, true, why, "sahara study predictions")
}
