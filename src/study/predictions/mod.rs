//! `predictions`: what was expected of the report's scenes before anything was measured.
//!
//! Each number in the words of an expectation is a claim of its own, which is confirmed or refuted by its whole
//! interval, or undecided. What was called open before anything was measured has figures and no verdict.
//!
//! The numbers come from what other studies have left in a folder: the journals of `attribution`, `scaling` and
//! `crossover`, `replicate.json` and `compare.json`. What takes seconds is counted here: rays, and tests on
//! Infinitycandy.

mod claims;
mod counted;
mod rank;
mod read;
mod table;
#[cfg(test)]
mod tests;

use serde::Serialize;

use super::attribution::Attribution;
use super::crossover::Race;
use super::scaling::Growth;
use crate::measure::{Estimate, Interval};
use crate::report::Record;
use crate::report::number::figures;

pub use claims::result;
pub use counted::{Case, key, measure, scenes};
pub use rank::kendall;
pub use read::{Main, Replicated, read};
pub use table::{table, tone};

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

/// One expectation in the words that were written before the measurement, and what came of it.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Prediction {
    /// From 1 to 8.
    pub number: u8,
    pub words: &'static str,
    /// Each number in the words is a claim of its own. None where the question was called open.
    pub claims: Vec<Claim>,
    /// What was measured where nothing was claimed: it has no verdict.
    pub figures: Vec<Figure>,
    /// What explains it; empty where nothing is measured.
    pub why: String,
    /// The command that measures it.
    pub command: &'static str,
}

/// One number against what was expected of it.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Claim {
    /// What is measured.
    pub what: String,
    /// What was measured, with the interval of one among all [`CLAIMS`]; nothing where it was not.
    pub value: Option<Estimate>,
    /// What was expected of it: `at least 20`.
    pub expected: String,
    pub verdict: Verdict,
}

/// A number of which nothing was claimed.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Figure {
    pub what: String,
    pub value: Estimate,
}

/// How many claims there are: all are judged together.
pub const CLAIMS: usize = 24;

/// What came of a claim.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Verdict {
    /// The whole interval is as expected.
    Confirmed,
    /// The whole interval is not.
    Refuted,
    /// The interval reaches across a bound, or is not known.
    Undecided,
    /// There is nothing to judge by.
    NotMeasured,
}

impl Verdict {
    /// As tables print it.
    pub fn words(self) -> &'static str {
        match self {
            Self::Confirmed => "confirmed",
            Self::Refuted => "refuted",
            Self::Undecided => "undecided",
            Self::NotMeasured => "not measured",
        }
    }
}

/// What is expected of a number: an end that is not there has no bound.
#[derive(Clone, Copy, Debug)]
struct Bounds {
    low: f64,
    high: f64,
}

impl Bounds {
    fn within(low: f64, high: f64) -> Self {
        Self { low, high }
    }

    fn at_least(low: f64) -> Self {
        Self { low, high: f64::INFINITY }
    }

    fn at_most(high: f64) -> Self {
        Self { low: f64::NEG_INFINITY, high }
    }

    fn words(self) -> String {
        match (self.low.is_finite(), self.high.is_finite()) {
            (true, true) => format!("{} to {}", figures(self.low), figures(self.high)),
            (true, false) => format!("at least {}", figures(self.low)),
            (false, _) => format!("at most {}", figures(self.high)),
        }
    }

    fn verdict(self, value: Option<Estimate>) -> Verdict {
        let Some(value) = value else { return Verdict::NotMeasured };
        let Some(Interval { low, high, .. }) = value.interval else { return Verdict::Undecided };
        match () {
            () if self.low <= low && high <= self.high => Verdict::Confirmed,
            () if high < self.low || low > self.high => Verdict::Refuted,
            () => Verdict::Undecided,
        }
    }
}

impl Claim {
    /// Of a positive ratio.
    fn ratio(what: impl Into<String>, value: Option<Estimate>, bounds: Bounds) -> Self {
        Self::judged(what, value.map(|value| value.ratio_among(CLAIMS)), bounds)
    }

    /// Of any other number.
    fn number(what: impl Into<String>, value: Option<Estimate>, bounds: Bounds) -> Self {
        Self::judged(what, value.map(|value| value.among(CLAIMS)), bounds)
    }

    /// Of a number whose interval allows for all claims already.
    fn judged(what: impl Into<String>, value: Option<Estimate>, bounds: Bounds) -> Self {
        Self { what: what.into(), value, expected: bounds.words(), verdict: bounds.verdict(value) }
    }
}

/// How many claims came to what.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Tally {
    pub claims: usize,
    pub confirmed: usize,
    pub refuted: usize,
    pub undecided: usize,
    pub not_measured: usize,
}

/// That of all predictions.
pub fn tally(predictions: &[Prediction]) -> Tally {
    let claims = || predictions.iter().flat_map(|prediction| &prediction.claims);
    let count = |verdict| claims().filter(|claim| claim.verdict == verdict).count();
    let [confirmed, refuted, undecided, not_measured] =
        [Verdict::Confirmed, Verdict::Refuted, Verdict::Undecided, Verdict::NotMeasured].map(count);
    Tally { claims: claims().count(), confirmed, refuted, undecided, not_measured }
}

impl Tally {
    /// `14 of 24 claims confirmed, 6 refuted, 3 undecided, 1 not measured`.
    pub fn words(&self) -> String {
        let mut words = format!("{} of {} claims confirmed, {} refuted", self.confirmed, self.claims, self.refuted);
        for (n, what) in [(self.undecided, "undecided"), (self.not_measured, "not measured")] {
            if n > 0 {
                words += &format!(", {n} {what}");
            }
        }
        words
    }
}
