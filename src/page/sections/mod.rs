//! The whole page: the answer, the pictures, a section for each study, and the provenance.

mod answer;

use super::document::{Document, Section};
use super::runs::{Runs, StudyRun, also_measured, scene_titles};
use crate::report::number::plural;
use crate::report::words::{ended, listed};
use crate::report::{Block, Table};
use crate::study::{Dataset, Studies};

pub use answer::tally;

pub fn document(runs: &Runs, studies: &Studies, pictures: Vec<Section>) -> Document {
    let (title, answer) = answer::answer(runs);
    let sections = pictures.into_iter().chain(runs.studies.iter().map(section)).collect();
    let mut document = Document { title, answer, sections };
    let mut known = vec![];
    document.sections.iter_mut().for_each(|section| name_apart(&mut section.blocks, &mut known));
    let missing = studies.iter().filter(|study| runs.of(study.name).is_none());
    let missing = missing.map(|study| Block::missing(study.question, &study.command_line())).collect();
    document.sections.push(provenance(runs, missing));
    document
}

fn section(run: &StudyRun) -> Section {
    let StudyRun { study, others, report, .. } = run;
    let found = report.findings.iter().filter(|own| !own.sentence.is_empty());
    let mut blocks: Vec<Block> = found.map(|finding| Block::Text(finding.sentence.clone())).collect();
    blocks.extend(report.verdict_table().map(Block::Table));
    blocks.extend(report.blocks.iter().cloned());
    let failures = report.failures.iter().map(|failure| &failure.sentence).filter(|sentence| !sentence.is_empty());
    blocks.extend(failures.chain(&report.warnings).map(|sentence| Block::Note(ended(sentence))));
    blocks.extend(others.iter().map(|other| Block::Note(also_measured(other))));
    Section { id: study.name, title: study.question, command: run.commands().join("\n"), blocks }
}

/// Makes figure ids unique. Scenes with similar names can cause equal figure ids.
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

fn provenance(runs: &Runs, missing: Vec<Block>) -> Section {
    let note = "For each study and scene, the page uses the newest cases that share settings, build and machine. The \
                page shows the settings, build and machine with the most cases of a study.";
    let mut blocks = vec![Block::Table(machines(runs).noted([note]))];
    blocks.extend(runs.notes.iter().map(|note| Block::Note(note.clone())));
    if !missing.is_empty() {
        blocks.push(Block::Fold(format!("Not measured: {}", plural(missing.len(), "part")), missing));
    }
    Section { id: "provenance", title: "Provenance", blocks, ..Section::default() }
}

fn machines(runs: &Runs) -> Table {
    let row = |study: &str, dataset: &Dataset, shown: &str| {
        let p = &dataset.provenance;
        let pinned = if p.pinned.is_some() { ", pinned" } else { "" };
        let governor = p.governor.as_ref().map_or(String::new(), |governor| format!("; governor {governor}"));
        [
            format!("{study}{shown}"),
            listed(&scene_titles(dataset)),
            p.cpu.clone(),
            p.simd.clone(),
            format!("{} of {} processors{pinned}; denormals {}{governor}", p.threads, p.cores, p.denormals),
            format!("{} {}, {}", p.version, p.commit, p.profile),
            p.rustc.clone(),
            p.target.clone(),
        ]
    };
    let rows = runs.studies.iter().flat_map(|run| {
        let others = run.others.iter().map(|other| row(run.study.name, other, ", also measured"));
        std::iter::once(row(run.study.name, &run.dataset, "")).chain(others)
    });
    Table::of_texts(
        "Machines and builds",
        ["study", "scenes", "processor", "instructions", "threads", "sahara", "compiler", "target"],
        rows.collect(),
    )
}
