//! The eight expectations. Pure functions of what was measured.

mod brute_force;
mod crowded;
mod depth;
mod growth;
mod ranking;
mod rays;
mod speedup;

use super::{Finding, Inputs, Prediction, Verdict};
use crate::measure::Interval;

/// All of them, in order.
pub fn result(inputs: &Inputs) -> Vec<Prediction> {
    vec![
        rays::rays(inputs),
        brute_force::brute_force(inputs),
        crowded::crowded(inputs),
        growth::growth(inputs),
        speedup::speedup(inputs),
        speedup::architecture(inputs),
        ranking::ranking(inputs),
        depth::depth(inputs),
    ]
}

/// `complete`: whether all that the claim speaks of is measured; a part of it can refute the claim, but not confirm it.
fn prediction(
    number: u8,
    claim: &str,
    findings: Vec<Finding>,
    complete: bool,
    why: String,
    command: &str,
) -> Prediction {
    let verdict = if findings.iter().any(|finding| !finding.holds) {
        Verdict::Refuted
    } else if complete && !findings.is_empty() {
        Verdict::Confirmed
    } else {
        Verdict::NotMeasured
    };
    Prediction {
        number,
        claim: claim.into(),
        verdict,
        why: if findings.is_empty() { String::new() } else { why },
        command: (!complete || findings.is_empty()).then(|| command.into()),
        findings,
    }
}

/// The quotient of two estimates that err independently: relative errors add in squares.
fn quotient(a: Interval, b: Interval) -> Interval {
    let log = |x: f64, y: f64| libm::fabs(libm::log(x / y));
    let estimate = a.estimate / b.estimate;
    let down = libm::hypot(log(a.estimate, a.low), log(b.high, b.estimate));
    let up = libm::hypot(log(a.high, a.estimate), log(b.estimate, b.low));
    Interval { estimate, low: estimate * libm::exp(-down), high: estimate * libm::exp(up) }
}
