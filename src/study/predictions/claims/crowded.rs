//! Does a tree help where all triangles crowd in one place?

use super::{Bounds, Claim, prediction};
use crate::measure::Estimate;
use crate::report::number::figures;
use crate::study::predictions::counted::{CROWDED, TREES};
use crate::study::predictions::{Inputs, Prediction};

pub(super) fn crowded(inputs: &Inputs) -> Prediction {
    let words = "Infinitycandy with the report's tree: 0.9 to 1.3 tests per ray per triangle; setting 50 / 0.7 does MORE tests than brute \
                 force.";
    let case = inputs.counted.iter().find(|case| case.scene == CROWDED && case.tests.len() == TREES.len());
    let share = |i: usize| case.map(|case| case.tests[i] as f64 / (case.rays as f64 * case.triangles as f64));
    let [report, other] = [share(0), share(1)];
    let claims = vec![
        Claim::number("100 / 0.7: tests per ray and triangle", report.map(Estimate::exact), Bounds::within(0.9, 1.3)),
        // As many as brute force are not more.
        Claim {
            expected: "more than 1".into(),
            ..Claim::number(
                "50 / 0.7: tests per ray and triangle",
                other.map(Estimate::exact),
                Bounds::at_least(1.0_f64.next_up()),
            )
        },
    ];
    let against = |share: f64| match share {
        share if share < 1.0 => format!("skips a share of {} of the tests of brute force", figures(1.0 - share)),
        share => format!("does {} times the tests of brute force", figures(share)),
    };
    let why = report.zip(other).map_or(String::new(), |(report, other)| {
        format!("With the default the tree {}, with 50 / 0.7 it {}.", against(report), against(other))
    });
    prediction(3, words, claims, why, "sahara study predictions")
}
