//! The source report's tables, measured again.

use crate::publish::document::{Block, Section};
use crate::publish::runs::{Runs, shown};
use crate::study::replicate::tables;

pub fn section(runs: &Runs) -> Section {
    let blocks = match &runs.replication {
        None => vec![Block::missing(
            "The source report's tables, ours beside its own",
            "sahara replicate --export-json runs/replicate.json",
        )],
        Some(replication) => {
            let command = shown(&replication.provenance.command);
            let text = "Rays, seconds and parameters as in the source report, ours beside its own. Seconds are of \
                        different machines and code: compare their ratios.";
            let tables = tables(replication).into_iter().map(|table| Block::table(table, &command));
            std::iter::once(Block::Text(text.into())).chain(tables).collect()
        }
    };
    Section { id: "report", title: "The source report, measured again", blocks }
}
