//! The verdict of a hard case on a structure.

use crate::study::Verdict;
use crate::validate::Kind;
use crate::validate::hard_cases::{Failure, Score};

/// The verdict of a score on a structure. A property counts as the rays of its check.
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
