//! How many claims are confirmed.

use super::{Prediction, Verdict};

/// `14 of 24 claims confirmed, 6 refuted, 3 undecided, 1 not measured`.
pub fn tally(predictions: &[Prediction]) -> String {
    let claims = || predictions.iter().flat_map(|prediction| &prediction.claims);
    let count = |verdict| claims().filter(|claim| claim.verdict == verdict).count();
    let [confirmed, refuted, undecided, not_measured] = Verdict::ALL.map(count);
    let mut words = format!("{confirmed} of {} claims confirmed, {refuted} refuted", claims().count());
    for (n, what) in [(undecided, Verdict::Undecided), (not_measured, Verdict::NotMeasured)] {
        if n > 0 {
            words += &format!(", {n} {}", what.name());
        }
    }
    words
}
