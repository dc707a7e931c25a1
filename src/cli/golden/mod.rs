//! The command `golden`: checks, updates and compares pictures.

mod blame;
mod compare;
mod scenes;

use std::io;
use std::path::{Path, PathBuf};

use serde_json::json;

use super::terminal::Terminal;
use crate::escaped::Escaped as _;
use crate::golden::page::{self, Page};
use crate::golden::{Comparison, Verdict};
use crate::output::{OutputError, OutputFile, OutputFolder};
use crate::registry::Registry;
use crate::report::number::count;
use crate::request::OUTPUT;
use crate::study::Status;

#[derive(Debug, clap::Subcommand)]
pub enum Action {
    /// Check that structures reproduce the golden images of scenes exactly
    Check(scenes::CheckArgs),
    /// Create or update golden images of scenes
    Update(scenes::UpdateArgs),
    /// Compare two pictures, or two folders of pictures, from any renderer
    Compare(compare::Args),
}

pub fn run(registry: &Registry, action: &Action, terminal: &Terminal) -> anyhow::Result<Status> {
    match action {
        Action::Check(args) => scenes::check(registry, args, terminal),
        Action::Update(args) => scenes::update(registry, args, terminal),
        Action::Compare(args) => compare::run(args, terminal),
    }
}

/// Outputs in addition to the terminal.
#[derive(Debug, clap::Args)]
#[command(next_help_heading = OUTPUT)]
struct Outputs {
    /// Write a web page of all comparisons into this folder, replacing an older page
    #[arg(long, value_name = "DIR")]
    page: Option<PathBuf>,
    /// Write the comparisons as JSON
    #[arg(long, value_name = "FILE")]
    export_json: Option<PathBuf>,
}

struct CheckedOutputs {
    page: Option<OutputFolder>,
    json: Option<OutputFile>,
}

impl Outputs {
    fn check<'a>(&self, inputs: impl Iterator<Item = &'a Path> + Clone) -> anyhow::Result<CheckedOutputs> {
        anyhow::ensure!(self.page.is_none() || cfg!(feature = "page"), "--page: {}", crate::cli::NO_PAGE);
        let page = self.page.as_deref().map(|path| OutputFolder::check(path)?.apart_from(inputs.clone()));
        let json = self.export_json.as_deref().map(|path| OutputFile::check(path)?.apart_from(inputs));
        Ok(CheckedOutputs { page: page.transpose()?, json: json.transpose()? })
    }
}

impl CheckedOutputs {
    fn with_page<T>(&self, title: &str, run: impl FnOnce(Option<&Page>) -> io::Result<T>) -> Result<T, OutputError> {
        match &self.page {
            Some(folder) => page::write(folder, title, |page| run(Some(page))),
            None => Ok(run(None).expect("nothing is written")),
        }
    }

    fn export(&self, comparisons: &[Comparison], terminal: &Terminal) -> anyhow::Result<()> {
        if let Some(json) = &self.json {
            let run = json!({ "schema": "sahara-golden-1", "comparisons": comparisons });
            json.write(&serde_json::to_vec_pretty(&run)?)?;
        }
        if let Some(folder) = &self.page {
            terminal.print(&format!("{}\n", page::index(&folder.path).escaped()));
        }
        Ok(())
    }
}

/// Each verdict with its name in tables and its name in tallies.
const VERDICTS: [(Verdict, &str, &str); 6] = [
    (Verdict::Differs, "differs", "different"),
    (Verdict::Failed, "failed", "failed"),
    (Verdict::Missing, "missing", "missing"),
    (Verdict::Additional, "additional", "additional"),
    (Verdict::Accepted, "accepted", "accepted"),
    (Verdict::Identical, "identical", "identical"),
];

fn tally(comparisons: &[Comparison]) -> String {
    let number = |verdict| comparisons.iter().filter(|own| own.verdict == verdict).count() as u64;
    let parts =
        VERDICTS.map(|(verdict, _, name)| (number(verdict), name)).into_iter().filter(|(number, _)| *number > 0);
    parts.map(|(number, name)| format!("{} {name}", count(number))).collect::<Vec<_>>().join(", ")
}
