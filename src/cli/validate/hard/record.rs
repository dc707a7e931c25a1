//! Scores as data.

use serde_json::{Value, json};

use super::verdict::verdict;
use crate::registry::Choice;
use crate::validate::hard_cases::{HardCase, Score};

/// One structure on one case. Unknown numbers are null.
pub fn record(case: &HardCase, choice: &Choice, score: &Score) -> Value {
    let rays = score.rays();
    let judged = rays.map(|rays| &rays.judged);
    json!({
        "number": case.number,
        "case": case.name,
        "rank": case.rank,
        "structure": choice.entry.name,
        "label": choice.label,
        "triangle_test": choice.triangle_test(),
        // `answered`, `hang`, `panic`, `crash`, `refused` or `declined`.
        "outcome": match score {
            Score::Failed(failure) => failure.name(),
            _ => "answered",
        },
        "clean": score.is_clean(),
        "rays": judged.map(|judged| judged.rays),
        "hits": judged.map(|judged| judged.hits),
        "missed": judged.map(|judged| judged.missed),
        "false_hits": judged.map(|judged| judged.false_hits),
        // By more than 4 ulps and more than 1e-6.
        "wrong_depth": judged.map(|judged| judged.wrong_depth),
        // Wrong by more than 1 %, or 0.1 % at another primitive.
        "coarse_depth": rays.map(|rays| rays.coarse_depth),
        "wrong_primitive": judged.map(|judged| judged.wrong_primitive),
        "structure_errors": rays.filter(|rays| rays.knows_structure_errors).map(|rays| rays.validation.structure_errors),
        "verdict": verdict(score),
        "contradictions": rays.map(|rays| rays.contradictions),
        "inexact": rays.map(|rays| rays.inexact),
        "ulps": judged.and_then(|judged| judged.ulps),
        "slowness": rays.and_then(|rays| rays.slowness),
        "build_ns": rays.map(|rays| rays.build_ns),
        // Only for a case that is a property.
        "property": match score {
            Score::Property(property) => Some(property),
            _ => None,
        },
    })
}
