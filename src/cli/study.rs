//! Running a study: `study NAME`, and those that have a command of their own.

use std::path::PathBuf;

use clap::{ArgMatches, Args as _, FromArgMatches};

use super::Session;
use super::progress::OnTerminal;
use crate::output::OutputFile;
use crate::report::plot::Format;
use crate::report::to_markdown;
use crate::study::{AnyStudy, Chosen, Measured, Run, Status};

/// Where studies keep their journals.
pub const RUNS: &str = "runs";

/// Options of every study beside its own.
#[derive(Clone, Debug, Default, clap::Args)]
pub struct Common {
    /// The folder of journals: the same command again goes on where the last one stopped [default: runs; there a study of seconds, and
    /// `compare`, keep only what Ctrl-C has interrupted]
    #[arg(long, value_name = "DIR")]
    pub dir: Option<PathBuf>,
    /// Throw away all that the folder of the study holds, cases of other scenes and settings as well, and start anew
    #[arg(long)]
    pub fresh: bool,
    /// Measure all scenes and epochs in one process: quicker, but how it happens to lie in memory is then in none of the
    /// intervals
    #[arg(long)]
    pub in_process: bool,
    /// Write the result as JSON
    #[arg(long, value_name = "FILE")]
    pub export_json: Option<PathBuf>,
    /// Write one row per measured thing as CSV
    #[arg(long, value_name = "FILE")]
    pub export_csv: Option<PathBuf>,
    /// Write the tables as Markdown
    #[arg(long, value_name = "FILE")]
    pub export_markdown: Option<PathBuf>,
    /// Draw the answer, if the study has a picture of it: error against time of `accuracy`; may be repeated
    #[arg(long, value_name = "F.svg|F.png")]
    pub plot: Vec<PathBuf>,
}

#[derive(Default)]
struct Files {
    json: Option<OutputFile>,
    csv: Option<OutputFile>,
    markdown: Option<OutputFile>,
    plots: Vec<(OutputFile, Format)>,
}

impl Common {
    /// Refuses files that cannot be written. Scenes take seconds to load, and only then it is known what the files must not be.
    fn check_places(&self) -> anyhow::Result<()> {
        let exports = [&self.export_json, &self.export_csv, &self.export_markdown].into_iter().flatten();
        exports.chain(&self.plot).try_for_each(|path| Ok(OutputFile::check_place(path)?))
    }

    /// Checks all files before the long run; none of them is one of `inputs`.
    fn check(&self, inputs: &[PathBuf]) -> anyhow::Result<Files> {
        let file = |path: &PathBuf| -> anyhow::Result<OutputFile> {
            Ok(OutputFile::check(path)?.apart_from(inputs.iter().map(PathBuf::as_path))?)
        };
        let check = |path: &Option<PathBuf>| path.as_ref().map(file).transpose();
        let (json, csv, markdown) =
            (check(&self.export_json)?, check(&self.export_csv)?, check(&self.export_markdown)?);
        let plots = self.plot.iter().map(|path| anyhow::Ok((file(path)?, Format::of(path)?)));
        let files = Files { json, csv, markdown, plots: plots.collect::<anyhow::Result<_>>()? };
        let tables = [&files.json, &files.csv, &files.markdown].into_iter().flatten();
        let all: Vec<&OutputFile> = tables.chain(files.plots.iter().map(|(file, _)| file)).collect();
        for (i, file) in all.iter().enumerate() {
            file.unlike(&all[..i])?;
        }
        Ok(files)
    }
}

/// The command of a study.
pub fn command(study: &dyn AnyStudy) -> clap::Command {
    let command = Common::augment_args(study.augment(clap::Command::new(study.name())));
    // The options come with what they themselves are about.
    command.about(study.question()).long_about(None)
}

/// Runs a study from its own command line.
pub fn run(session: &Session, study: &dyn AnyStudy, matches: &ArgMatches) -> anyhow::Result<Status> {
    run_as(session, study, Chosen::Matches(matches), &Common::from_arg_matches(matches)?)
}

/// Runs a study, prints what it says and writes the files.
pub fn run_as(session: &Session, study: &dyn AnyStudy, chosen: Chosen, common: &Common) -> anyhow::Result<Status> {
    let &Session { suite, terminal, .. } = session;
    let folder = common.dir.clone().unwrap_or_else(|| RUNS.into());
    let mut screen = OnTerminal::new(terminal);
    let mut run = Run {
        registry: &suite.registry,
        others: &|| suite.studies.answers(&folder, study.name()),
        folder: &folder,
        is_kept: common.dir.is_some() || study.is_kept(),
        fresh: common.fresh,
        processes: session.processes(common),
        screen: &mut screen,
    };
    // A picture that there is not is refused before the long run.
    anyhow::ensure!(
        common.plot.is_empty() || study.has_plot(),
        "study {} has no picture: leave --plot out",
        study.name()
    );
    common.check_places()?;
    let mut files = Files::default();
    let measured = study.run(chosen, &mut run, &mut |inputs| {
        files = common.check(inputs)?;
        Ok(())
    })?;
    drop(screen);

    let Measured { answer, provenance, tables, mut legend, to_print, to_explain, foot, outcome, failures } = measured;
    to_print.iter().for_each(|table| terminal.print_table(table));
    terminal.print_lines(&to_explain);
    terminal.print_lines(&foot);
    failures.iter().for_each(crate::output::tell_error);
    // Files are written whole, when all is measured.
    let Some(answer) = answer else { return Ok(outcome) };
    let answer = answer.as_ref();
    if let Some(file) = files.json {
        file.write(&study.json(answer, &provenance))?;
    }
    if let Some(file) = files.csv {
        file.write(&study.csv(answer, &provenance))?;
    }
    if let Some(file) = files.markdown {
        legend.extend(foot);
        file.write(&to_markdown(&tables, &legend))?;
    }
    for (file, format) in files.plots {
        let plot = study.plot(answer).expect("a study that says so has a picture");
        file.write(&plot.bytes(format))?;
    }
    Ok(outcome)
}
