//! What was expected before anything was measured, and what came of it.

use crate::publish::document::{Block, Section};
use crate::publish::runs::{Runs, Study};
use crate::publish::words::table;
use crate::report::Cell;
use crate::report::words::interval;
use crate::study::predictions::{Claim, Inputs, Prediction, Verdict, result, table as claims, tally, tone};

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
    if predictions.iter().all(|p| p.figures.is_empty() && p.claims.iter().all(|claim| claim.value.is_none())) {
        vec![]
    } else {
        predictions
    }
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
    (!predictions.is_empty()).then(|| format!("Written before the measurement: {}.", tally(&predictions).words()))
}

pub fn section(runs: &Runs) -> Section {
    let predictions = predictions(runs);
    let command = runs.predictions.as_ref().map_or("sahara study predictions".to_owned(), |study| study.command());
    let mut blocks = vec![];
    if predictions.is_empty() {
        blocks.push(Block::missing("Verdicts on the claims", &command));
    } else {
        blocks.push(Block::Text(format!("{}.", tally(&predictions).words())));
        let mut verdicts = table("Claims and verdicts", ["no.", "claim", "expected", "measured", "verdict"], vec![]);
        verdicts.rows = predictions.iter().flat_map(|p| p.claims.iter().map(|claim| row(p.number, claim))).collect();
        blocks.push(Block::table(verdicts, &command));
        let told = |p: &&Prediction| {
            let refuted = p.claims.iter().any(|claim| claim.verdict == Verdict::Refuted);
            (refuted || p.claims.is_empty()) && !p.why.is_empty()
        };
        let whys = predictions.iter().filter(told);
        blocks.extend(whys.map(|p| Block::Text(format!("{}. {}", p.number, short(&p.why)))));
        let all = Block::table(claims(&predictions), &command);
        blocks.push(Block::Fold("The words as they were written, and all explanations".into(), vec![all]));
    }
    Section { id: "predictions", title: "What was expected, and what came of it?", blocks }
}

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

fn row(number: u8, claim: &Claim) -> Vec<Cell> {
    vec![
        number.to_string().into(),
        claim.what.as_str().into(),
        claim.expected.as_str().into(),
        claim.value.map_or(Cell::blank(), |value| interval(value).into()),
        Cell::from(claim.verdict.words()).with(tone(claim.verdict)),
    ]
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
