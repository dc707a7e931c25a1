//! Where the numbers come from.

use crate::escaped::Escaped as _;
use crate::measure::Provenance;
use crate::page::runs::Runs;
use crate::report::Table;
use crate::report::document::{Block, Section};
use crate::report::number::plural;
use crate::report::words::{command_line, each_once};

/// Every file and every machine; `missing` is what no run has measured.
pub fn section(runs: &Runs, missing: Vec<Block>) -> Section {
    let sources = runs.sources.iter().map(|source| {
        let path = source.path.escaped().to_string();
        [path, source.kind.clone(), source.command.clone(), source.replaced.clone()]
    });
    let mut files = Table::of_texts(
        "Files that this report was made from, oldest first",
        ["file or folder", "holds", "made by", "left out"],
        sources.collect(),
    );
    files.notes.push(
        "Where several files measured the same scene with the same command, the one last written counts: samples of \
         different runs are no pairs. Comparisons on different machines stand side by side; of several builds on one machine \
         the one with the most times counts."
            .into(),
    );
    let mut blocks = vec![Block::table(files, ""), Block::table(machines(&runs.provenances), "")];
    blocks.extend(warnings(&runs.provenances).map(|table| Block::table(table, "")));
    blocks.extend(runs.notes.iter().map(|note| Block::Note(note.clone())));
    if !missing.is_empty() {
        blocks.push(Block::Fold(format!("Not measured: {}", plural(missing.len(), "part")), missing));
    }
    Section { id: "provenance", title: "Where the numbers come from", blocks }
}

/// One row for each machine and build.
fn machines(all: &[Provenance]) -> Table {
    let row = |p: &Provenance| {
        let pinned = if p.pinned.is_some() { ", pinned" } else { "" };
        let governor = p.governor.as_ref().map_or(String::new(), |governor| format!("; governor {governor}"));
        [
            p.cpu.clone(),
            p.simd.clone(),
            format!("{} of {} processors{pinned}; denormals {}{governor}", p.threads, p.cores, p.denormals),
            format!("{} {}, {}", p.version, p.commit, p.profile),
            p.rustc.clone(),
            p.target.clone(),
        ]
    };
    Table::of_texts(
        "Machines and builds",
        ["processor", "instructions", "threads", "sahara", "compiler", "target"],
        each_once(all.iter().map(row)),
    )
}

/// What spoilt runs, as they say themselves.
fn warnings(all: &[Provenance]) -> Option<Table> {
    let rows = all.iter().flat_map(|p| p.warnings.iter().map(|warning| [command_line(&p.command), warning.clone()]));
    let rows: Vec<[String; 2]> = rows.collect();
    (!rows.is_empty()).then(|| Table::of_texts("What spoilt these runs", ["command", "warning"], rows))
}
