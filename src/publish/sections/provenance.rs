//! Where the numbers come from.

use crate::measure::Provenance;
use crate::publish::document::{Block, Section};
use crate::publish::runs::{Runs, shown};
use crate::publish::words::table;
use crate::report::number::plural;

/// Every file and every machine; `missing` is what no run has measured.
pub fn section(runs: &Runs, missing: Vec<(String, String)>) -> Section {
    let sources = runs.sources.iter().map(|source| {
        let path = source.path.display().to_string();
        [path, source.kind.clone(), source.command.clone(), source.replaced.clone()]
    });
    let mut files = table(
        "Files that this report was made from, oldest first",
        ["file", "holds", "made by", "left out"],
        sources.collect(),
    );
    files.notes.push(
        "Where several files measured the same scene with the same command, the one last written counts: samples of \
         different runs are no pairs."
            .into(),
    );
    let mut blocks = vec![Block::table(files, ""), Block::table(machines(&runs.provenances()), "")];
    if !missing.is_empty() {
        let rows = missing.into_iter().map(|(what, command)| [what, command]);
        let title = format!("Not measured: {}", plural(rows.len(), "part"));
        blocks.push(Block::table(table(&title, ["what", "command"], rows.collect()), ""));
    }
    Section { id: "provenance", title: "Where the numbers come from", blocks }
}

/// One row for each run whose provenance differs in more than its command.
fn machines(all: &[&Provenance]) -> crate::report::Table {
    let mut rows: Vec<[String; 6]> = vec![];
    for p in all {
        let row = [
            p.cpu.clone(),
            format!("{} ({} of {} processors)", p.simd, p.threads, p.cores),
            format!("{} {}", p.version, p.commit),
            format!("{}, {}", p.rustc, p.profile),
            format!("{}, {}", p.os, p.target),
            shown(&p.command),
        ];
        if !rows.contains(&row) {
            rows.push(row);
        }
    }
    table("Machines and builds", ["processor", "instructions", "sahara", "compiler", "system", "command"], rows)
}
