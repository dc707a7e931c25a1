//! The command `diff`: compares two runs.

use std::path::PathBuf;

use super::terminal::Terminal;
use crate::output::OutputFile;
use crate::report::{Report, markdown};
use crate::request::{OUTPUT, STRUCTURES};
use crate::study::Status;
use crate::study::diff::{Comparison, Side, cautions, read, sentences, settings, tables, unlike};

const GATE: &str = "Gate";

#[derive(Debug, clap::Args)]
pub struct Args {
    /// Old run: a file of --export-json or a folder of --dir
    #[arg(value_name = "A")]
    old: PathBuf,
    /// New run
    #[arg(value_name = "B")]
    new: PathBuf,
    /// Exit with status 3 if a structure is at least PERCENT slower and the interval of its slowdown lies above 0;
    /// otherwise with status 4 if the interval of any structure contains PERCENT or is unknown
    #[arg(long, help_heading = GATE, value_name = "PERCENT", value_parser = percent)]
    fail_on_regression: Option<f64>,
    /// Total number of times that you will run this comparison while you add epochs (sequential looks); intervals are
    /// widened to allow for it
    #[arg(long, help_heading = GATE, value_name = "N", default_value_t = 1, requires = "fail_on_regression", value_parser = clap::value_parser!(u8).range(1..=100))]
    looks: u8,
    /// Structure that is the same in both runs; changes are relative to it [default: the obvhs structures]
    #[arg(long, help_heading = STRUCTURES, value_name = "NAME")]
    reference: Option<String>,
    /// Write the comparison as JSON
    #[arg(long, help_heading = OUTPUT, value_name = "FILE")]
    export_json: Option<PathBuf>,
    /// Write the tables as Markdown
    #[arg(long, help_heading = OUTPUT, value_name = "FILE")]
    export_markdown: Option<PathBuf>,
}

fn percent(text: &str) -> Result<f64, &'static str> {
    let percent = text.trim_end_matches('%').parse().ok().filter(|percent: &f64| *percent > 0.0 && *percent <= 1000.0);
    percent.ok_or("give a percentage above 0 and at most 1000")
}

pub fn run(args: &Args, terminal: &Terminal) -> anyhow::Result<Status> {
    let inputs = [args.old.as_path(), args.new.as_path()];
    let check = |path: &Option<PathBuf>| -> anyhow::Result<Option<OutputFile>> {
        path.as_deref().map(|path| Ok(OutputFile::check(path)?.apart_from(inputs)?)).transpose()
    };
    let (json, markdown_file) = (check(&args.export_json)?, check(&args.export_markdown)?);
    OutputFile::are_apart(json.iter().chain(&markdown_file))?;
    let (old, new) = (read(&args.old)?, read(&args.new)?);
    let [a, b] = [&old, &new].map(|run| Side::new(run, args.reference.as_deref()));
    unlike(&a, &b, args.fail_on_regression.is_some())?;
    if let Some(name) = &args.reference {
        anyhow::ensure!(
            a.has_reference() && b.has_reference(),
            "--reference {name}: the runs do not share this structure; name one that both have measured"
        );
    }

    let mut comparison = Comparison::new(&a, &b, args.fail_on_regression, args.looks.into());
    if let (Some(a), Some(b)) = (old.measured.first(), new.measured.first()) {
        comparison.settings = settings(&a.case, &b.case);
    }
    let tables = tables(&comparison);
    tables.iter().for_each(|table| terminal.print_results(table));
    let mut notes = vec![format!("Old: {}", a.provenance.line()), format!("New: {}", b.provenance.line())];
    for (side, dataset) in [("Old", &old), ("New", &new)] {
        notes.extend(dataset.notes.iter().map(|note| format!("{side}: {note}")));
    }
    let foot = [cautions(&comparison), sentences(&comparison)].concat();
    terminal.print_notes(notes.clone());
    terminal.print_lines(&foot);
    if let Some(file) = json {
        file.write(&serde_json::to_vec_pretty(&comparison)?)?;
    }
    if let Some(file) = markdown_file {
        let report = Report { blocks: tables.into_iter().map(Into::into).collect(), ..Report::default() };
        file.write(markdown::report(&report, &[notes, foot].concat()).as_bytes())?;
    }
    Ok(comparison.status())
}
