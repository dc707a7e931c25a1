//! The verdicts as a table for people.

use super::{Finding, Prediction, Verdict};
use crate::report::words::interval;
use crate::report::{Cell, Table, Tone};

/// One row for each finding; claims, explanations and missing commands below.
pub fn table(predictions: &[Prediction]) -> Table {
    let mut rows = vec![];
    for p in predictions {
        let tone = match p.verdict {
            Verdict::Confirmed => Tone::Best,
            Verdict::Refuted => Tone::Wrong,
            Verdict::NotMeasured => Tone::Plain,
        };
        let verdict = Cell::from(p.words()).with(tone);
        rows.push(vec![p.number.to_string().into(), verdict, Cell::blank(), Cell::blank()]);
        let row = |f: &Finding| {
            let holds = match (f.holds, f.sure) {
                (true, true) => "yes",
                (true, false) => "yes, not surely",
                (false, true) => "no",
                (false, false) => "no, not surely",
            };
            vec![
                format!("  {}", f.what).into(),
                Cell::from(holds),
                interval(f.value).into(),
                f.expected.as_str().into(),
            ]
        };
        rows.extend(p.findings.iter().map(row));
    }
    let mut notes = vec![];
    for p in predictions {
        let missing = p.command.as_ref().map(|command| format!(" To measure it: {command}.")).unwrap_or_default();
        let why = if p.why.is_empty() { String::new() } else { format!(" {}", p.why) };
        notes.push(format!("{}. {} {}.{why}{missing}", p.number, p.claim, capitalised(&p.words())));
    }
    notes.push("Not surely: the interval reaches across the bound.".into());
    let count = |verdict| predictions.iter().filter(|p| p.verdict == verdict).count();
    Table {
        title: format!(
            "{} predictions: {} confirmed, {} refuted, {} not measured",
            predictions.len(),
            count(Verdict::Confirmed),
            count(Verdict::Refuted),
            count(Verdict::NotMeasured)
        ),
        columns: ["prediction", "holds", "measured [95%]", "expected"].map(String::from).into(),
        rows,
        notes,
    }
}

fn capitalised(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or(String::new(), |first| first.to_uppercase().chain(letters).collect())
}
