//! The verdicts as a table for people.

use super::{CLAIMS, Prediction, Verdict};
use crate::report::words::{explained, interval};
use crate::report::{Cell, Table, Tone};

/// How a verdict is coloured.
pub fn tone(verdict: Verdict) -> Tone {
    match verdict {
        Verdict::Confirmed => Tone::Best,
        Verdict::Refuted => Tone::Wrong,
        Verdict::Undecided | Verdict::NotMeasured => Tone::Plain,
    }
}

/// One row for each claim and each figure; the words, explanations and missing commands below.
pub fn table(predictions: &[Prediction]) -> Table {
    let mut rows: Vec<Vec<Cell>> = vec![];
    for p in predictions {
        rows.extend(p.claims.iter().map(|claim| {
            vec![
                format!("{}. {}", p.number, claim.what).into(),
                Cell::from(claim.verdict.name()).with(tone(claim.verdict)),
                claim.value.map(interval).into(),
                claim.expected.as_str().into(),
            ]
        }));
        rows.extend(p.figures.iter().map(|figure| {
            let what = format!("{}. {}", p.number, figure.what);
            vec![what.into(), Cell::blank(), interval(figure.value).into(), "open".into()]
        }));
    }
    let mut notes = vec![format!(
        "Confirmed or refuted: the whole interval is as expected, or is not. Intervals of claims allow for {CLAIMS} of them judged together; \
         figures without a claim have no verdict. The words name no number for what is well ordered (a tau of 0.7 or more), badly (0.5 or \
         less) and near 1 (0.8 to 1.2): these bounds are ours."
    )];
    for p in predictions {
        let missing =
            p.claims.iter().any(|claim| claim.value.is_none()) || (p.claims.is_empty() && p.figures.is_empty());
        let missing = if missing { format!(" To measure it: {}.", p.command) } else { String::new() };
        let why = if p.why.is_empty() { String::new() } else { format!(" {}", p.why) };
        notes.push(format!("{}. \"{}\"{why}{missing}", p.number, p.words));
    }
    explained(
        Table::new(
            format!("Claims written before the measurement: {}", tally(predictions)),
            ["claim", "verdict", "measured", "expected"],
            rows,
        )
        .noted(notes),
    )
}

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
