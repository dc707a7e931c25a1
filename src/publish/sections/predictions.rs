//! What was expected before anything was measured, and what came of it.

use crate::publish::document::{Block, Section};
use crate::publish::runs::{Runs, Study};
use crate::publish::words::table;
use crate::report::words::interval;
use crate::report::{Cell, Tone};
use crate::study::predictions::{Finding, Inputs, Prediction, Verdict, result, table as findings};

/// The verdicts. Nothing where no run tells anything about any of them.
pub fn predictions(runs: &Runs) -> Vec<Prediction> {
    let inputs = Inputs {
        counted: of(&runs.predictions),
        replicated: runs.replication.as_ref().map(replicated),
        attribution: of(&runs.attribution),
        scaling: of(&runs.scaling),
        crossover: of(&runs.crossover),
        compare: runs.records.clone(),
    };
    let predictions = result(&inputs);
    if predictions.iter().all(|p| p.verdict == Verdict::NotMeasured) { vec![] } else { predictions }
}

/// What came of a study, or nothing.
fn of<T: Clone>(study: &Option<Study<Vec<T>>>) -> Vec<T> {
    study.as_ref().map_or(vec![], |study| study.result.clone())
}

/// The part of a replication that predictions are about.
fn replicated(replication: &crate::study::replicate::Replication) -> crate::study::predictions::Replicated {
    let value = serde_json::to_value(replication).expect("a replication has text keys");
    serde_json::from_value(value).expect("a replication has all that is asked of it")
}

/// One sentence for the answer.
pub fn sentence(runs: &Runs) -> Option<String> {
    let predictions = predictions(runs);
    let count = |verdict| predictions.iter().filter(|p| p.verdict == verdict).count();
    let [confirmed, refuted, missing] = [Verdict::Confirmed, Verdict::Refuted, Verdict::NotMeasured].map(count);
    let missing = if missing > 0 { format!(", {missing} not measured") } else { String::new() };
    let unsure = match predictions.iter().filter(|p| !p.is_sure()).count() {
        0 => String::new(),
        n => format!(", {n} of these verdicts not surely"),
    };
    (!predictions.is_empty()).then(|| {
        format!(
            "Of {} predictions that were made before anything was measured, {confirmed} are confirmed and {refuted} \
             refuted{missing}{unsure}.",
            predictions.len()
        )
    })
}

pub fn section(runs: &Runs) -> Section {
    let predictions = predictions(runs);
    let command = runs.predictions.as_ref().map_or("sahara study predictions".to_owned(), |study| study.command());
    let mut blocks = vec![];
    if predictions.is_empty() {
        blocks.push(Block::missing("Verdicts on the eight predictions", &command));
    } else {
        let mut verdicts = table("Predictions and verdicts", ["no.", "prediction", "verdict", "decided by"], vec![]);
        verdicts.rows = predictions.iter().map(row).collect();
        blocks.push(Block::table(verdicts, &command));
        let whys = predictions.iter().filter(|p| p.verdict == Verdict::Refuted && !p.why.is_empty());
        blocks.extend(whys.map(|p| Block::Text(format!("{}. {}", p.number, short(&p.why)))));
        let all = Block::table(findings(&predictions), &command);
        blocks.push(Block::Fold("All findings and explanations".into(), vec![all]));
    }
    Section { id: "predictions", title: "What was expected, and what came of it?", blocks }
}

/// Findings of one prediction that are shown at once.
const SHOWN: usize = 3;

/// Characters of an explanation that are shown at once.
const LENGTH: usize = 420;

/// An explanation, up to the end of a clause where it is long.
fn short(why: &str) -> String {
    let clause = |end: usize| [". ", "; ", ", "].iter().filter_map(|mark| why[..end].rfind(mark)).max();
    match why.char_indices().nth(LENGTH).and_then(|(end, _)| clause(end)) {
        Some(end) => format!("{} … (the rest is below)", &why[..end]),
        None => why.into(),
    }
}

fn row(p: &Prediction) -> Vec<Cell> {
    let tone = match p.verdict {
        Verdict::Confirmed => Tone::Best,
        Verdict::Refuted => Tone::Wrong,
        Verdict::NotMeasured => Tone::Plain,
    };
    let told = |f: &Finding| format!("{}: {}, expected {}", f.what, interval(f.value), f.expected);
    // What refutes it, or else the first.
    let mut refuting: Vec<String> = p.findings.iter().filter(|f| !f.holds).map(told).collect();
    if refuting.len() > SHOWN {
        let more = refuting.len() - SHOWN;
        refuting.truncate(SHOWN);
        refuting.push(format!("and {more} more"));
    }
    let deciding = if refuting.is_empty() { p.findings.iter().take(1).map(told).collect() } else { refuting };
    let deciding = match (&p.command, deciding.is_empty()) {
        (Some(command), true) => command.clone(),
        _ => deciding.join("; "),
    };
    vec![p.number.to_string().into(), p.claim.as_str().into(), Cell::from(p.words()).with(tone), deciding.into()]
}

#[cfg(test)]
mod tests {
    use super::{LENGTH, short};

    #[test]
    fn long_explanations_end_with_a_clause_and_not_within_a_number() {
        assert_eq!(short("It is 1.5, not 2."), "It is 1.5, not 2.");
        let long = format!("{}, 3.25 fewer, and more", "x".repeat(LENGTH - 10));
        assert_eq!(short(&long), format!("{} … (the rest is below)", "x".repeat(LENGTH - 10)));
        assert!(short(&"é".repeat(2 * LENGTH)).ends_with('é'));
    }
}
