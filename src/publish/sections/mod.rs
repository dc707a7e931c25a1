//! One file for each section: pure functions from runs to what is said.

mod accuracy;
mod answer;
mod attribution;
mod break_even;
mod costs;
mod crossover;
mod parameters;
mod partitions;
mod predictions;
mod provenance;
mod replicate;
mod scaling;
mod speed;

use super::document::{Block, Document, Section};
use super::runs::Runs;

pub use answer::QUESTION;
pub use predictions::predictions;

/// The order in which they are read: what was looked at, why it is faster, by how much, and what follows.
const ORDER: [&str; 14] = [
    "scenes",
    "predictions",
    "attribution",
    "heat",
    "speed",
    "scaling",
    "break-even",
    "crossover",
    "costs",
    "parameters",
    "accuracy",
    "partitions",
    "report",
    "provenance",
];

/// The whole report; `pictures` are the sections that are drawn and not measured.
pub fn document(runs: &Runs, pictures: Vec<Section>) -> Document {
    let mut sections = vec![
        attribution::section(runs),
        speed::section(runs),
        scaling::section(runs),
        break_even::section(runs),
        crossover::section(runs),
        costs::section(runs),
        parameters::section(runs),
        predictions::section(runs),
        accuracy::section(runs),
        partitions::section(runs),
        replicate::section(runs),
    ];
    sections.extend(pictures);
    sections.sort_by_key(|section| ORDER.iter().position(|id| *id == section.id));
    let mut document = Document { title: QUESTION.into(), answer: answer::answer(runs), sections };
    let missing = document.missing().into_iter().map(|m| (m.what.clone(), m.command.clone())).collect();
    let mut known = vec![];
    document.sections.iter_mut().for_each(|section| name_apart(&mut section.blocks, &mut known));
    document.sections.push(provenance::section(runs, missing));
    document
}

/// Gives figures of one name, as scenes of much the same name have, names of their own.
fn name_apart(blocks: &mut [Block], known: &mut Vec<String>) {
    for block in blocks {
        match block {
            Block::Fold(_, inner) => name_apart(inner, known),
            Block::Figure(figure) => {
                let names = std::iter::once(figure.id.clone()).chain((2..).map(|n| format!("{}-v{n}", figure.id)));
                let free = names.into_iter().find(|name| !known.contains(name));
                figure.id = free.expect("there are more numbers than figures");
                known.push(figure.id.clone());
            }
            _ => {}
        }
    }
}
