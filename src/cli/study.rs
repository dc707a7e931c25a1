//! Runs a study: `study NAME`, and the studies that are top-level commands.

use std::path::PathBuf;

#[cfg(feature = "page")]
use anyhow::Context;
use clap::{ArgMatches, Args as _, FromArgMatches};

use super::progress::OnTerminal;
use super::{NO_PAGE, Session};
use crate::escaped::Escaped as _;
use crate::output::{OutputFile, STDOUT};
#[cfg(feature = "page")]
use crate::report::{Figure, plot::WIDTH};
use crate::report::{csv, markdown};
use crate::request::{MEASURING, OUTPUT};
use crate::study::{self, Run, RunOutcome, Status, Study};

pub const RUNS: &str = "runs";

/// How the results of a run are kept.
#[derive(Clone, Debug, Default, clap::Args)]
#[command(next_help_heading = MEASURING)]
pub struct Keeping {
    /// Folder that keeps the results, one journal per study. Repeat the command to resume an interrupted run; runs with
    /// other scenes or settings are added [default: runs; in `compare`: no journal]
    #[arg(long, help_heading = OUTPUT, value_name = "DIR")]
    pub dir: Option<PathBuf>,
    /// Measure every case again, even if the journal has it. Earlier results are kept; reports use the newest result of
    /// each case
    #[arg(long)]
    pub fresh: bool,
    /// Run everything in one process: faster, but the intervals no longer cover memory-layout effects, and builds have
    /// no time limit
    #[arg(long)]
    pub in_process: bool,
}

/// Options of every study, in addition to its own.
#[derive(Clone, Debug, Default, clap::Args)]
#[command(next_help_heading = OUTPUT)]
pub struct Common {
    #[command(flatten)]
    pub keeping: Keeping,
    /// Write the results as JSON, for `report` and `diff`
    #[arg(long, value_name = "FILE")]
    pub export_json: Option<PathBuf>,
    /// Write the results as CSV, one row per measurement
    #[arg(long, value_name = "FILE")]
    pub export_csv: Option<PathBuf>,
    /// Write the tables as Markdown
    #[arg(long, value_name = "FILE")]
    pub export_markdown: Option<PathBuf>,
    /// Write the study's first figure as an SVG file; may be repeated, which writes the same figure into each file
    #[arg(long, value_name = "F.svg")]
    pub plot: Vec<PathBuf>,
}

struct Files {
    json: Option<OutputFile>,
    csv: Option<OutputFile>,
    markdown: Option<OutputFile>,
    plots: Vec<OutputFile>,
}

impl Files {
    fn iter(&self) -> impl Iterator<Item = &OutputFile> {
        [&self.json, &self.csv, &self.markdown].into_iter().flatten().chain(&self.plots)
    }
}

impl Common {
    /// Rejects output files that cannot be written. Call this function before slow work.
    fn files(&self) -> anyhow::Result<Files> {
        let check = |path: &PathBuf| OutputFile::check(path);
        let files = Files {
            json: self.export_json.as_ref().map(check).transpose()?,
            csv: self.export_csv.as_ref().map(check).transpose()?,
            markdown: self.export_markdown.as_ref().map(check).transpose()?,
            plots: self.plot.iter().map(check).collect::<Result<_, _>>()?,
        };
        OutputFile::are_apart(files.iter())?;
        let is_svg = |path: &&PathBuf| path.as_os_str() == STDOUT || path.extension().is_some_and(|end| end == "svg");
        if let Some(path) = self.plot.iter().find(|path| !is_svg(path)) {
            anyhow::bail!("cannot plot to {}: give a file name that ends in .svg", path.escaped());
        }
        anyhow::ensure!(self.plot.is_empty() || cfg!(feature = "page"), "--plot: {NO_PAGE}");
        Ok(files)
    }
}

/// Ids of the options that `--help` shows and `-h` hides.
const RARE: &str = "camera inside size quality runner_limit reference only like runs budget threads seed build_limit \
                    fresh in_process export_csv export_markdown plot";

pub fn command(study: &Study) -> clap::Command {
    let command = Common::augment_args((study.options)().name(study.name));
    // `augment_args` has replaced the description with the doc comment of `Common`.
    let command = command.about(study.question).long_about(None);
    command.mut_args(|option| {
        let is_rare = RARE.split(' ').any(|rare| option.get_id() == rare);
        option.hide_short_help(is_rare)
    })
}

pub fn run(session: &Session, study: &Study, matches: &ArgMatches) -> anyhow::Result<Status> {
    run_as(session, study, matches, &Common::from_arg_matches(matches)?)
}

pub fn run_as(session: &Session, study: &Study, matches: &ArgMatches, common: &Common) -> anyhow::Result<Status> {
    let &Session { suite, terminal, .. } = session;
    let Keeping { dir, fresh, in_process } = &common.keeping;
    let folder = dir.clone().unwrap_or_else(|| RUNS.into());
    let mut screen = OnTerminal::new(terminal, false);
    let files = common.files()?;
    let plan = (study.plan)(matches, &suite.registry)?;
    files.iter().try_for_each(|file| file.clone().apart_from(plan.inputs.iter().map(PathBuf::as_path)).map(drop))?;
    let mut run = Run {
        registry: &suite.registry,
        folder: &folder,
        keep_journal: dir.is_some().then_some(true),
        fresh: *fresh,
        processes: session.processes.filter(|_| !in_process),
        screen: &mut screen,
    };
    let outcome = study::run(study, matches, &plan, &mut run)?;
    drop(screen);

    let RunOutcome { dataset, report, tables, notes, foot, status, failures } = outcome;
    tables.iter().for_each(|table| terminal.print_results(table));
    terminal.print_notes(notes.clone());
    terminal.print_lines(&foot);
    failures.iter().for_each(crate::output::print_error);
    if let Some(dataset) = dataset {
        if let Some(file) = files.json {
            file.write(&dataset.to_json())?;
        }
        if let Some(file) = files.csv {
            file.write(&csv::table(&report.data))?;
        }
        if let Some(file) = files.markdown {
            file.write(markdown::report(&report, &[notes, foot].concat()).as_bytes())?;
        }
        #[cfg(feature = "page")]
        for file in files.plots {
            let chart = report.figures().find_map(Figure::chart);
            let chart = chart.with_context(|| format!("study {} has no figure: omit --plot", study.name))?;
            file.write(chart.svg(WIDTH).as_bytes())?;
        }
    }
    Ok(status)
}
