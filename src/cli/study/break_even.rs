//! `study break-even`.

use super::epochs::Study;
use crate::cli::Verdict;
use crate::cli::terminal::Terminal;
use crate::registry::Registry;
use crate::scene::WorkloadKind;
use crate::study::break_even::{LEGEND, NAME, STRUCTURES, result, rows, tables};

pub use super::epochs::OnScenes as Args;

const STUDY: Study = Study {
    name: NAME,
    structures: &STRUCTURES,
    workloads: &[WorkloadKind::Primary, WorkloadKind::Diffuse],
    legend: &LEGEND,
};

pub fn run(registry: &Registry, args: &Args, terminal: &Terminal) -> anyhow::Result<Verdict> {
    let files = args.field.options.exports.check()?;
    let (epochs, foot, provenance, verdict) = args.measured(&STUDY, registry, terminal)?;
    let markets = result(&epochs);
    files.tell(terminal, (NAME, &provenance), &markets, &rows(&markets), &tables(&markets), &foot)?;
    Ok(verdict)
}
