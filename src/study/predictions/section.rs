//! What was expected before anything was measured, and what came of it.

use super::{Claim, Prediction, Verdict, table as claims, tally, tone};
use crate::report::document::Block;
use crate::report::number::plural;
use crate::report::words::interval;
use crate::report::{Cell, Table};

/// One sentence for the answer of the page; nothing where no claim could be judged.
pub fn sentence(predictions: &[Prediction]) -> Option<String> {
    let judged = predictions.iter().flat_map(|p| &p.claims).any(Claim::is_judged);
    judged.then(|| format!("Written before the measurement: {}.", tally(predictions)))
}

pub fn blocks(predictions: &[Prediction], command: &str) -> Vec<Block> {
    let mut verdicts =
        Table::of_texts("Claims and verdicts", ["no.", "claim", "expected", "measured", "verdict"], vec![]);
    let (measured, missing): (Vec<_>, Vec<_>) = predictions
        .iter()
        .flat_map(|p| p.claims.iter().map(|claim| (p.number, claim)))
        .partition(|(_, claim)| claim.value.is_some());
    verdicts.rows = measured.into_iter().map(|(number, claim)| row(number, claim)).collect();
    let mut blocks = vec![Block::table(verdicts, command)];
    if !missing.is_empty() {
        let missing = plural(missing.len(), "claim");
        blocks.push(Block::Note(format!("{missing} not measured: `sahara study all` measures all of them.")));
    }
    let told = |p: &&Prediction| {
        let refuted = p.claims.iter().any(|claim| claim.verdict == Verdict::Refuted);
        (refuted || p.claims.is_empty()) && !p.why.is_empty()
    };
    let whys = predictions.iter().filter(told);
    blocks.extend(whys.map(|p| Block::Text(format!("{}. {}", p.number, short(&p.why)))));
    let all = Block::table(claims(predictions), command);
    blocks.push(Block::Fold("The words as they were written, and all explanations".into(), vec![all]));
    blocks
}

/// Characters of an explanation that are shown at once.
const LENGTH: usize = 420;

/// Stands behind an explanation that is cut short, where the whole one is folded below.
pub const REST_BELOW: &str = " (the rest is below)";

/// An explanation, up to the end of a clause where it is long.
fn short(why: &str) -> String {
    let clause = |end: usize| [". ", "; ", ", "].iter().filter_map(|mark| why[..end].rfind(mark)).max();
    match why.char_indices().nth(LENGTH).and_then(|(end, _)| clause(end)) {
        Some(end) => format!("{} …{REST_BELOW}", &why[..end]),
        None => why.into(),
    }
}

fn row(number: u8, claim: &Claim) -> Vec<Cell> {
    vec![
        number.to_string().into(),
        claim.what.as_str().into(),
        claim.expected.as_str().into(),
        claim.value.map(interval).into(),
        Cell::from(claim.verdict.name()).with(tone(claim.verdict)),
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
