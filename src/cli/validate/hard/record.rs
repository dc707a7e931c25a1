//! Converts scores of hard cases to JSON and to verdicts.

use serde_json::{Value, json};

use crate::registry::Choice;
use crate::study::Verdict;
use crate::validate::hard_cases::{Failure, HardCase, Score};
use crate::validate::{ErrorCounts, Kind};

pub fn record(case: &HardCase, choice: &Choice, score: &Score) -> Value {
    let rays = score.rays();
    let count = |number: fn(&ErrorCounts) -> u64| rays.map(|rays| number(&rays.error_counts));
    json!({
        "number": case.number,
        "case": case.name,
        "rank": case.rank,
        "structure": choice.entry.name,
        "label": choice.label,
        "triangle_test": choice.triangle_test(),
        "outcome": match score {
            Score::Failed(failure) => failure.name(),
            _ => "answered",
        },
        "clean": score.is_clean(),
        "rays": count(|own| own.rays),
        "hits": count(|own| own.hits),
        "missed": count(|own| own.missed),
        "false_hits": count(|own| own.false_hits),
        // A wrong depth has an error above 4 ulps and a relative error above 1e-6.
        "wrong_depth": count(|own| own.wrong_depth),
        // A coarse depth has an error above 1 %, or above 0.1 % on a wrong primitive.
        "coarse_depth": rays.map(|rays| rays.coarse_depth),
        "wrong_primitive": count(|own| own.wrong_primitive),
        "structure_errors": rays.filter(|rays| rays.knows_structure_errors).map(|rays| rays.validation.structure_errors),
        "verdict": verdict(score),
        "contradictions": rays.map(|rays| rays.contradictions),
        "inexact": rays.map(|rays| rays.inexact),
        "ulps": rays.and_then(|rays| rays.error_counts.ulps),
        "slowness": rays.and_then(|rays| rays.slowness),
        "build_ns": rays.map(|rays| rays.build_ns),
        "property": match score {
            Score::Property(property) => Some(property),
            _ => None,
        },
    })
}

/// Each check of a property counts as a ray.
pub fn verdict(score: &Score) -> Verdict {
    let failed = |fault| Verdict { rays: 1, wrong: 1, rounded: 0, fault };
    match score {
        Score::Rays(score) => {
            let verdict = Verdict::from(&score.validation);
            let fault = verdict.fault.or((score.contradictions > 0).then_some(Kind::AnyHitDisagrees));
            Verdict { wrong: (verdict.wrong + score.contradictions).min(verdict.rays), fault, ..verdict }
        }
        Score::Property(property) => Verdict { rays: property.checked, wrong: property.broken, ..Verdict::default() },
        Score::Failed(Failure::Hang) => failed(Some(Kind::Hangs)),
        Score::Failed(Failure::Panic | Failure::Crash) => failed(Some(Kind::Panicked)),
        Score::Failed(Failure::Refused(_) | Failure::Declined(_)) => Verdict::default(),
    }
}
