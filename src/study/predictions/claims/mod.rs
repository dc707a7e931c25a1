//! The seven expectations. Pure functions of what was measured.

mod brute_force;
mod crowded;
mod growth;
mod ranking;
mod rays;
mod speedup;

use super::{Bounds, Claim, Figure, Inputs, Prediction};

/// All of them, in order.
pub fn result(inputs: &Inputs) -> Vec<Prediction> {
    vec![
        rays::rays(inputs),
        brute_force::brute_force(inputs),
        crowded::crowded(inputs),
        growth::growth(inputs),
        speedup::speedup(inputs),
        speedup::architecture(inputs),
        ranking::ranking(inputs),
    ]
}

/// One with claims; `why` is said only where something is measured.
fn prediction(number: u8, words: &'static str, claims: Vec<Claim>, why: String, command: &'static str) -> Prediction {
    let why = if claims.iter().any(|claim| claim.value.is_some()) { why } else { String::new() };
    Prediction { number, words, claims, figures: vec![], why, command }
}
