//! One file for each section: pure functions from runs to what is said.

mod accuracy;
mod answer;
mod attribution;
mod break_even;
mod costs;
mod crossover;
mod partitions;
mod provenance;
mod replicate;
mod scaling;
mod speed;

use super::document::{Document, Section};
use super::runs::Runs;

pub use answer::QUESTION;

/// The whole report; `pictures` are the sections that are drawn and not measured.
pub fn document(runs: &Runs, pictures: Vec<Section>) -> Document {
    let mut sections = vec![attribution::section(runs), speed::section(runs)];
    sections.extend(pictures);
    sections.extend([scaling::section(runs), break_even::section(runs), crossover::section(runs)]);
    sections.extend([
        costs::section(runs),
        accuracy::section(runs),
        partitions::section(runs),
        replicate::section(runs),
    ]);
    let mut document = Document { title: QUESTION.into(), answer: answer::answer(runs), sections };
    let missing = document.missing().into_iter().map(|m| (m.what.clone(), m.command.clone())).collect();
    document.sections.push(provenance::section(runs, missing));
    document
}
