//! `predictions`: what was expected of the report's scenes before anything was measured; each expectation confirmed or refuted.
//!
//! The numbers come from what other studies have left in a folder: the journals of `attribution`, `scaling` and `crossover`,
//! `replicate.json` and `compare.json`. What takes seconds is counted here: rays, and tests on Infinitycandy.

mod claims;
mod counted;
mod rank;
mod read;
mod table;
#[cfg(test)]
mod tests;

use serde::{Deserialize, Serialize};

use super::attribution::Attribution;
use super::crossover::Race;
use super::scaling::Growth;
use crate::measure::Interval;
use crate::report::Record;

pub use claims::result;
pub use counted::{Case, key, measure, scenes};
pub use rank::kendall;
pub use read::{Main, Replicated, read};
pub use table::table;

/// Name of the study, and of its journal.
pub const NAME: &str = "predictions";

/// What there is to judge by. What is missing is empty.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Inputs {
    /// Counted by [`measure`].
    pub counted: Vec<Case>,
    pub replicated: Option<Replicated>,
    pub attribution: Vec<Attribution>,
    pub scaling: Vec<Growth>,
    pub crossover: Vec<Race>,
    pub compare: Vec<Record>,
}

/// One expectation and what came of it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Prediction {
    /// From 1 to 8.
    pub number: u8,
    /// What was expected: a sentence.
    pub claim: String,
    pub verdict: Verdict,
    /// What it is judged by; all of it must hold.
    pub findings: Vec<Finding>,
    /// What explains it, above all where it is refuted; empty where nothing is measured.
    pub why: String,
    /// The command that measures what is missing.
    pub command: Option<String>,
}

impl Prediction {
    /// Whether the intervals of what decides the verdict stay within their bounds.
    pub fn is_sure(&self) -> bool {
        let deciding = |finding: &&Finding| finding.holds == (self.verdict == Verdict::Confirmed);
        let mut deciding = self.findings.iter().filter(deciding);
        match self.verdict {
            Verdict::Confirmed => deciding.all(|finding| finding.sure),
            Verdict::Refuted => deciding.any(|finding| finding.sure),
            Verdict::NotMeasured => true,
        }
    }

    /// The verdict in words; `not surely` where it is not sure.
    pub fn words(&self) -> String {
        format!("{}{}", self.verdict.words(), if self.is_sure() { "" } else { ", not surely" })
    }
}

/// What came of an expectation.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Verdict {
    /// Every finding holds.
    Confirmed,
    /// A finding does not hold.
    Refuted,
    /// There is nothing to judge by.
    NotMeasured,
}

impl Verdict {
    /// As tables print it.
    pub fn words(self) -> &'static str {
        match self {
            Self::Confirmed => "confirmed",
            Self::Refuted => "refuted",
            Self::NotMeasured => "not measured",
        }
    }
}

/// One number against what was expected of it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Finding {
    /// What was measured.
    pub what: String,
    pub value: Interval,
    /// What was expected of it: `at least 20`.
    pub expected: String,
    /// Whether the estimate is as expected.
    pub holds: bool,
    /// Whether the whole interval agrees with that.
    pub sure: bool,
}

impl Finding {
    /// A number that is expected in `low..=high`.
    pub fn within(what: impl Into<String>, value: Interval, low: f64, high: f64) -> Self {
        use crate::report::number::figures;
        let inside = |x: f64| low <= x && x <= high;
        let holds = inside(value.estimate);
        let sure = if holds { inside(value.low) && inside(value.high) } else { value.high < low || value.low > high };
        let expected = match (low.is_finite(), high.is_finite()) {
            (true, true) => format!("{} to {}", figures(low), figures(high)),
            (true, false) => format!("at least {}", figures(low)),
            (false, _) => format!("at most {}", figures(high)),
        };
        Self { what: what.into(), value, expected, holds, sure }
    }

    /// A count, which does not vary.
    pub fn exact(what: impl Into<String>, value: f64, low: f64, high: f64) -> Self {
        Self::within(what, Interval { estimate: value, low: value, high: value }, low, high)
    }
}
