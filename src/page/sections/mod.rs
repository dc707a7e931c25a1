//! The whole page: a section for each study, in the order of the list, and the frame around them.

mod answer;
mod provenance;

use super::document::{Document, Section};
use super::runs::{Runs, StudyRun, also_measured};
use crate::report::Block;
use crate::report::words::ended;
use crate::study::Studies;

pub use answer::tally;

/// The whole report. `pictures` are the sections that are drawn and not measured. Studies without a measurement are
/// listed at the end, with their commands.
pub fn document(runs: &Runs, studies: &Studies, pictures: Vec<Section>) -> Document {
    let (title, answer) = answer::answer(runs);
    let sections = pictures.into_iter().chain(runs.studies.iter().map(section)).collect();
    let mut document = Document { title, answer, sections };
    let mut known = vec![];
    document.sections.iter_mut().for_each(|section| name_apart(&mut section.blocks, &mut known));
    let missing = studies.iter().filter(|study| runs.of(study.name).is_none());
    let missing = missing.map(|study| Block::missing(study.question, &study.command_line())).collect();
    document.sections.push(provenance::section(runs, missing));
    document
}

/// The findings of a study, its verdicts on claims, and its blocks.
fn section(run: &StudyRun) -> Section {
    let StudyRun { study, others, report, .. } = run;
    // The name of the fastest structure is the verdict of the page, not a sentence.
    let found = report.findings.iter().filter(|own| !own.sentence.is_empty());
    let mut blocks: Vec<Block> = found.map(|finding| Block::Text(finding.sentence.clone())).collect();
    blocks.extend(report.verdict_table().map(Block::Table));
    blocks.extend(report.blocks.iter().cloned());
    let failures = report.failures.iter().map(|failure| &failure.sentence).filter(|sentence| !sentence.is_empty());
    blocks.extend(failures.chain(&report.warnings).map(|sentence| Block::Note(ended(sentence))));
    blocks.extend(others.iter().map(|other| Block::Note(also_measured(other))));
    Section { id: study.name, title: study.question, command: run.commands().join("\n"), blocks }
}

/// Renames figures of equal name, which scenes with similar names have.
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
