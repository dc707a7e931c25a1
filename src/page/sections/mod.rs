//! The whole page: a section for each study, in the order of the list, and what frames them.

mod answer;
mod provenance;

use super::runs::Runs;
use crate::report::document::{Block, Document, Section};
use crate::study::Studies;

/// The whole report; `pictures` are the sections that are drawn and not measured. Studies whose answers have no data are named at
/// the end, with the commands that measure them.
pub fn document(runs: &Runs, studies: &Studies, pictures: Vec<Section>) -> Document {
    let (mut sections, mut missing) = (pictures, vec![]);
    let (title, answer) = answer::answer(runs);
    // Runs on somebody's own scenes are not about what was expected of the report's.
    let studies = if answer.chart.is_some() { studies.iter().collect() } else { studies.in_order_of_measuring() };
    for study in studies {
        let answer = runs.answers.get(study.name());
        let answer = answer.filter(|answer| study.data(*answer).iter().any(|data| !data.rows.is_empty()));
        match answer {
            Some(answer) => {
                let found = study.statements(answer).into_iter().map(|statement| Block::Text(statement.sentence));
                let elsewhere = runs.elsewhere(study.name()).map(|[own, leading]| {
                    Block::Note(format!("Measured on {own}; the comparison of all structures is of {leading}."))
                });
                let blocks = found.chain(elsewhere).chain(study.section(answer, &runs.command(study))).collect();
                sections.push(Section { id: study.name(), title: study.question(), blocks });
            }
            None => missing.push(Block::missing(study.question(), &study.command())),
        }
    }
    let mut document = Document { title, answer, sections };
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
