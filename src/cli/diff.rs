//! `diff`.

use std::path::{Path, PathBuf};

use super::terminal::Terminal;
use crate::escaped::Escaped as _;
use crate::measure::Provenance;
use crate::output::OutputFile;
use crate::report::{Export, Record, to_json, to_markdown};
use crate::study::Status;
use crate::study::diff::{Comparison, Machines, tables, unlike};

#[derive(Debug, clap::Args)]
pub struct Args {
    /// Records of the old run, as `compare --export-json` writes them
    #[arg(value_name = "A.json")]
    old: PathBuf,
    /// Records of the new run
    #[arg(value_name = "B.json")]
    new: PathBuf,
    /// Write the comparison as JSON
    #[arg(long, value_name = "FILE")]
    export_json: Option<PathBuf>,
    /// Write the tables as Markdown
    #[arg(long, value_name = "FILE")]
    export_markdown: Option<PathBuf>,
}

pub fn run(args: &Args, terminal: &Terminal) -> anyhow::Result<Status> {
    let inputs = [args.old.as_path(), args.new.as_path()];
    let check = |path: &Option<PathBuf>| -> anyhow::Result<Option<OutputFile>> {
        path.as_deref().map(|path| Ok(OutputFile::check(path)?.apart_from(inputs)?)).transpose()
    };
    let (json, markdown) = (check(&args.export_json)?, check(&args.export_markdown)?);
    let (old, new) = (records(&args.old)?, records(&args.new)?);
    unlike(&old, &new, Machines::Any)?;

    let comparison = Comparison::new(&old, &new, None, 1);
    let tables = tables(&comparison);
    tables.iter().for_each(|table| terminal.print_table(table));
    let of = |records: &[Record]| records.first().map_or(String::new(), |record| record.provenance.line());
    let foot = [format!("Old: {}", of(&old)), format!("New: {}", of(&new))];
    terminal.print_lines(&foot);
    if let Some(file) = json {
        file.write(&to_json(&Export::new("diff", &Provenance::capture(1), &comparison)))?;
    }
    if let Some(file) = markdown {
        file.write(&to_markdown(&tables, &foot))?;
    }
    Ok(if comparison.wrong.is_empty() { Status::Right } else { Status::Wrong })
}

fn records(path: &Path) -> anyhow::Result<Vec<Record>> {
    let text = std::fs::read(path).map_err(|cause| {
        anyhow::anyhow!("cannot read {} ({cause}): give a file of `sahara compare --export-json`", path.escaped())
    })?;
    let records: Vec<Record> = serde_json::from_slice(&text).map_err(|cause| {
        anyhow::anyhow!("{} holds no records of `sahara compare --export-json`: {cause}", path.escaped())
    })?;
    anyhow::ensure!(!records.is_empty(), "{} holds no record: there is nothing to compare", path.escaped());
    Ok(records)
}
