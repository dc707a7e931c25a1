//! The origin of the numbers.

use crate::measure::Provenance;
use crate::page::document::Section;
use crate::page::runs::{Runs, scene_titles};
use crate::report::number::plural;
use crate::report::words::{command_line, each_once, listed};
use crate::report::{Block, Table};
use crate::study::Dataset;

/// Every machine; `missing` lists the missing measurements.
pub fn section(runs: &Runs, missing: Vec<Block>) -> Section {
    let note = "For each study and scene, the page uses the newest cases that share settings, build and machine. The \
                page shows the settings, build and machine with the most cases of a study.";
    let mut blocks = vec![Block::Table(machines(runs).noted([note]))];
    blocks.extend(warnings(&runs.provenances()).map(Block::Table));
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

/// The warnings of the runs.
fn warnings(all: &[&Provenance]) -> Option<Table> {
    let rows = all.iter().flat_map(|p| p.warnings.iter().map(|warning| [command_line(&p.command), warning.clone()]));
    let rows: Vec<[String; 2]> = each_once(rows);
    (!rows.is_empty()).then(|| Table::of_texts("Conditions that disturbed these runs", ["command", "warning"], rows))
}
