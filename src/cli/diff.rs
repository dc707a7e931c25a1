//! `diff`.

use std::path::{Path, PathBuf};

use serde_json::Value;

use super::terminal::Terminal;
use crate::escaped::Escaped as _;
use crate::output::OutputFile;
use crate::report::{Report, markdown};
use crate::study::diff::{Comparison, Side, settings, tables, unlike};
use crate::study::journal::{CaseFile, JournalError, files, newest};
use crate::study::{Dataset, Status};

#[derive(Debug, clap::Args)]
pub struct Args {
    /// The old run: a file of `--export-json`, or a folder of --dir
    #[arg(value_name = "A")]
    old: PathBuf,
    /// The new run
    #[arg(value_name = "B")]
    new: PathBuf,
    /// Exit with status 3 if a structure is slower by more than so many percent, with 4 if the samples do not tell
    #[arg(long, value_name = "PERCENT", value_parser = percent)]
    fail_on_regression: Option<f64>,
    /// How often the gate looks at most, measuring more in between: every look is a chance to be wrong
    #[arg(long, value_name = "N", default_value_t = 1, requires = "fail_on_regression", value_parser = clap::value_parser!(u8).range(1..=100))]
    looks: u8,
    /// Write the comparison as JSON
    #[arg(long, value_name = "FILE")]
    export_json: Option<PathBuf>,
    /// Write the tables as Markdown
    #[arg(long, value_name = "FILE")]
    export_markdown: Option<PathBuf>,
}

fn percent(text: &str) -> Result<f64, String> {
    let percent = text.trim_end_matches('%').parse::<f64>().ok();
    percent
        .filter(|percent| *percent > 0.0 && *percent <= 1000.0)
        .ok_or("give per cent, above 0 and at most 1000".into())
}

pub fn run(args: &Args, terminal: &Terminal) -> anyhow::Result<Status> {
    let inputs = [args.old.as_path(), args.new.as_path()];
    let check = |path: &Option<PathBuf>| -> anyhow::Result<Option<OutputFile>> {
        path.as_deref().map(|path| Ok(OutputFile::check(path)?.apart_from(inputs)?)).transpose()
    };
    let (json, markdown_file) = (check(&args.export_json)?, check(&args.export_markdown)?);
    let (old, new) = (dataset(&args.old)?, dataset(&args.new)?);
    let [a, b] = [&old, &new].map(Side::new);
    unlike(&a, &b, args.fail_on_regression.is_some())?;

    let mut comparison = Comparison::new(&a, &b, args.fail_on_regression, args.looks.into());
    if let (Some(a), Some(b)) = (old.measured.first(), new.measured.first()) {
        comparison.settings = settings(&a.case, &b.case);
    }
    let tables = tables(&comparison);
    tables.iter().for_each(|table| terminal.print_table(table));
    let mut foot = vec![format!("Old: {}", a.provenance.line()), format!("New: {}", b.provenance.line())];
    for (side, dataset) in [("Old", &old), ("New", &new)] {
        foot.extend(dataset.notes.iter().map(|note| format!("{side}: {note}")));
    }
    terminal.print_lines(&foot);
    if let Some(file) = json {
        file.write(&serde_json::to_vec_pretty(&comparison)?)?;
    }
    if let Some(file) = markdown_file {
        let report = Report { blocks: tables.into_iter().map(Into::into).collect(), ..Report::default() };
        file.write(markdown::report(&report, &foot).as_bytes())?;
    }
    Ok(comparison.status())
}

/// The dataset of an export, or that of a folder of journals which was measured last, of `compare` if it has any.
fn dataset(path: &Path) -> anyhow::Result<Dataset> {
    let advice = "give a file of `--export-json`, or a folder of `--dir`";
    let found = if path.is_dir() {
        let mut paths = files(path)?;
        for entry in std::fs::read_dir(path)?.flatten().filter(|entry| entry.path().is_dir()) {
            paths.extend(files(&entry.path())?);
        }
        let mut cases = vec![];
        for path in paths {
            match CaseFile::read(&path) {
                Ok(case) => cases.push(case),
                // A folder may hold exports besides.
                Err(JournalError::Foreign(_)) => {}
                Err(error) => return Err(error.into()),
            }
        }
        if cases.iter().any(|own: &CaseFile| own.case.study == "compare") {
            cases.retain(|own| own.case.study == "compare");
        }
        newest(cases)
    } else {
        let text = std::fs::read(path)
            .map_err(|cause| anyhow::anyhow!("cannot read {} ({cause}): {advice}", path.escaped()))?;
        let value: Value = serde_json::from_slice(&text)
            .map_err(|cause| anyhow::anyhow!("{} is torn or no JSON ({cause}): {advice}", path.escaped()))?;
        anyhow::ensure!(Dataset::is_dataset(&value), "{} is no export of a study: {advice}", path.escaped());
        Some(Dataset::read(path, value)?)
    };
    let found = found.filter(|own| !own.measured.is_empty());
    found.ok_or_else(|| anyhow::anyhow!("{} holds nothing that was measured: {advice}", path.escaped()))
}
