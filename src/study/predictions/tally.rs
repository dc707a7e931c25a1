//! How many claims are confirmed.

use serde::Serialize;

use super::{Prediction, Verdict};

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
