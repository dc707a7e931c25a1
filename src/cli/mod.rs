//! The command `sahara`.
//!
//! Results go to stdout, progress and errors to stderr. `sahara --help` lists the exit statuses of all commands.

mod all;
mod completions;
mod diff;
#[cfg(test)]
mod documented;
pub(crate) mod exit_status;
mod fetch;
mod golden;
mod interrupt;
mod list;
mod moved;
mod plan;
mod progress;
mod rays;
mod render;
#[cfg(feature = "page")]
mod report;
mod study;
mod terminal;
mod validate;

use std::ffi::OsString;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::error::ErrorKind;
use clap::{ArgMatches, Args as _, FromArgMatches, Subcommand};

use crate::escaped::{Escaped as _, quoted};
use crate::measure::{keep_to, program};
use crate::names::suggestion;
use crate::panics;
use crate::registry::Registry;
use crate::simd::Level;
use crate::study::process::{self, Listened, Processes, Written, build_watch, measure_into};
use crate::study::{Case, Status, Studies, Study};
use progress::OnTerminal;
use terminal::{Colour, Terminal};

const ABOUT: &str = "Benchmark, validate and image-test ray-tracing acceleration structures.";

const LONG_ABOUT: &str = "Benchmark, validate and image-test ray-tracing acceleration structures.

Without a command: `compare` on the built-in scenes.";

pub struct Suite {
    pub registry: Registry,
    pub studies: Studies,
}

impl From<Registry> for Suite {
    fn from(registry: Registry) -> Self {
        Self { registry, studies: Studies::builtin() }
    }
}

/// Options of all commands.
#[derive(Debug, clap::Args)]
struct Global {
    /// When to use colour; `auto` asks the terminal and honours NO_COLOR
    #[arg(long, global = true, value_enum, default_value_t, value_name = "WHEN")]
    color: Colour,
    /// Show no progress and no warnings
    #[arg(long, short, global = true)]
    quiet: bool,
    /// Print all columns of tables, and what they mean
    #[arg(long, global = true)]
    verbose: bool,
    /// Run on these instructions instead of the best ones here: portable, avx2 or avx512, where this build has them; the answers are the same
    #[arg(long, global = true)]
    level: Option<Level>,
}

// Options of the processes that a run starts. No doc comment: clap would take it for what the whole command does.
#[derive(Debug, clap::Args)]
struct Process {
    /// Measure this case: how a run or a scheduler starts a process
    #[arg(id = "process-case", long = process::CASE, global = true, hide = true, requires = "process-out", value_parser = read_case)]
    case: Option<Case>,
    /// Write that case into this file
    #[arg(id = "process-out", long = process::OUT, global = true, hide = true, requires = "process-case")]
    out: Option<PathBuf>,
    /// Say on standard output what is done, and wait for an answer: a run listens
    #[arg(long = process::LISTEN, global = true, hide = true, requires = "process-case")]
    listen: bool,
    /// Keep to these cores
    #[arg(long = process::CORES, global = true, hide = true, requires = "process-case", value_delimiter = ',')]
    cores: Vec<usize>,
}

fn read_case(text: &str) -> Result<Case, String> {
    serde_json::from_str(text).map_err(|cause| format!("it is no case of this version of sahara: {cause}"))
}

struct Session<'a> {
    suite: &'a Suite,
    terminal: &'a Terminal,
    /// What starts a process for each case, unless all are to be measured in this one.
    processes: Option<&'a Processes>,
}

// The commands that are no study. No doc comment: clap would take it for what the whole command does.
#[derive(Debug, Subcommand)]
enum Command {
    /// Compare two runs (across machines: by their ratios to obvhs); with a threshold, a gate
    Diff(diff::Args),
    /// Hold every structure against a reference, hit for hit
    Validate(Box<validate::Args>),
    /// Record, import and show files of rays; write rays with exact answers
    Rays(rays::Args),
    /// Write what runs have measured as a page, Markdown and tidy data
    #[cfg(feature = "page")]
    Report(report::Args),
    /// Download the real meshes that scene files name, verified; licences are shown first
    Fetch(fetch::Args),
    /// Draw a picture
    Render(render::Args),
    /// Check or make the golden images
    Golden(golden::Args),
    /// Name what there is, and say what the keys of a structure mean
    List(list::Args),
    /// Print a completion script for a shell, or the manual page
    Completions(completions::Args),
}

/// The studies that are commands of their own.
const COMPARE: &str = "compare";
const REPLICATE: &str = "replicate";

const STUDY: &str = "study";

const REPORT: &str = "report";

/// What is said of HTML and figures where they are left out.
pub(crate) const NO_PAGE: &str = "this sahara was built without the feature `page`: build it with that feature";

/// The commands that people are shown.
fn shown(studies: &Studies) -> clap::Command {
    let whole = clap::Command::new("sahara").version(env!("CARGO_PKG_VERSION")).max_term_width(100);
    let mut command = Global::augment_args(whole).about(ABOUT).long_about(LONG_ABOUT).after_help(exit_status::STATUSES);
    command = command.subcommands(studies.find(COMPARE).map(study::command));
    command = command.subcommands(studies.find(REPLICATE).map(study::command));
    let all = clap::Command::new(all::NAME);
    let listed = clap::Command::new(STUDY)
        .about("Run an experiment with a question of its own")
        .subcommand_required(true)
        .arg_required_else_help(true)
        // A name that is no study gets the list of those there are.
        .allow_external_subcommands(true)
        .subcommand(all::Args::augment_args(all))
        .subcommand(plan::Args::augment_args(clap::Command::new(plan::NAME)))
        .subcommands(studies.iter().map(study::command));
    Command::augment_subcommands(command.subcommand(listed))
}

/// All commands and options: those that a run starts processes with, and names that went, are hidden.
fn command(studies: &Studies) -> clap::Command {
    let child = clap::Command::new(validate::CHILD).hide(true);
    let command = Process::augment_args(shown(studies)).subcommand(validate::ChildArgs::augment_args(child));
    let rest = || clap::Arg::new("rest").num_args(0..).trailing_var_arg(true).allow_hyphen_values(true);
    let old = |(name, _): &(&'static str, _)| clap::Command::new(*name).hide(true).disable_help_flag(true).arg(rest());
    let command = command.subcommands(moved::COMMANDS.iter().map(old));
    if cfg!(feature = "page") { command } else { command.subcommand(old(&(REPORT, NO_PAGE))) }
}

/// Runs the command line of this process over structures, with the studies of this crate, or over a whole [`Suite`].
pub fn main(suite: impl Into<Suite>) -> ExitCode {
    interrupt::watch();
    run_with(&suite.into(), std::env::args_os(), true)
}

const PANIC: &str = "the panic above ended the command: if it is a structure's, leave that out, or find the mesh or ray with \
                     `sahara validate`; else it is a fault of sahara";

/// Runs `args`, the name of the program first. They need not be those of this program, so all is measured in this process.
pub fn run(suite: &Suite, args: impl IntoIterator<Item = OsString>) -> ExitCode {
    run_with(suite, args, false)
}

fn run_with(suite: &Suite, args: impl IntoIterator<Item = OsString>, starts_processes: bool) -> ExitCode {
    // The date of what is measured is that of its beginning.
    program::started();
    let args: Vec<OsString> = args.into_iter().collect();
    let parsed = command(&suite.studies).try_get_matches_from(&args);
    let parsed = parsed
        .and_then(|matches| Ok((Global::from_arg_matches(&matches)?, Process::from_arg_matches(&matches)?, matches)));
    let (global, process, matches) = match parsed {
        Ok(parsed) => parsed,
        Err(message) if message.kind() == ErrorKind::InvalidUtf8 => return exit_status::of(Err(not_text(&args))),
        Err(message) => return exit_status::told(message),
    };
    if let Some(level) = global.level {
        level.choose();
    }
    let terminal = Terminal::new(global.color, global.quiet).verbose(global.verbose);
    // What `validate --hard` runs in a process of its own tells it of a panic by ending with one.
    let may_panic = matches.subcommand_name() == Some(validate::CHILD);
    let level = global.level.iter().flat_map(|level| ["--level", level.name()]).map(OsString::from);
    let processes = starts_processes.then(|| Processes { options: level.collect() });
    let session = Session { suite, terminal: &terminal, processes: processes.as_ref() };
    let run = || match (&process.case, &process.out) {
        (Some(case), Some(out)) => measure_case(&session, &process, case, out, args.clone()),
        _ => dispatch(&session, &matches, &global),
    };
    // A structure of another crate may panic where its command has nothing else to go on with.
    let found = if may_panic { Ok(run()) } else { catch_unwind(AssertUnwindSafe(run)) };
    exit_status::of(found.unwrap_or_else(|_| {
        panics::uncaught().iter().for_each(crate::output::tell);
        Err(anyhow::anyhow!(PANIC))
    }))
}

fn not_text(args: &[OsString]) -> anyhow::Error {
    let names: Vec<String> = args.iter().filter(|arg| arg.to_str().is_none()).map(quoted).collect();
    anyhow::anyhow!("{} is not UTF-8 text: files and folders may have such names, but nothing else", names.join(" or "))
}

fn measure_case(
    session: &Session,
    process: &Process,
    case: &Case,
    out: &Path,
    args: Vec<OsString>,
) -> anyhow::Result<Status> {
    let &Session { suite, terminal, .. } = session;
    if !process.cores.is_empty() {
        keep_to(&process.cores);
    }
    let watch = build_watch(case, args);
    if process.listen {
        let measured = measure_into(case, out, &suite.registry, &watch, &mut Listened::new());
        if let Err(error) = measured {
            process::report_failure(&error)?;
        }
        return Ok(Status::Right);
    }
    let tell = |what: &str| crate::output::tell(format_args!("{} {what}", out.escaped()));
    match measure_into(case, out, &suite.registry, &watch, &mut OnTerminal::of_job(terminal))? {
        Written::Now => {}
        Written::Before => tell("holds this case already: nothing is measured."),
        Written::Meanwhile => tell("has been written by another process meanwhile: its case is kept."),
    }
    Ok(Status::Right)
}

fn dispatch(session: &Session, matches: &ArgMatches, global: &Global) -> anyhow::Result<Status> {
    let &Session { suite, terminal, .. } = session;
    let registry = &suite.registry;
    match matches.subcommand() {
        None => {
            let compare = suite.studies.find(COMPARE).ok_or_else(|| anyhow::anyhow!("name a command: see --help"))?;
            return study::run_as(session, compare, &compare.defaults(), &study::Common::default());
        }
        Some((name @ (COMPARE | REPLICATE), matches)) => return study::run(session, find(suite, name)?, matches),
        Some((STUDY, matches)) => match matches.subcommand() {
            Some((all::NAME, matches)) => return all::run(session, &all::Args::from_arg_matches(matches)?),
            Some((plan::NAME, matches)) => {
                return plan::run(session, &plan::Args::from_arg_matches(matches)?, global.level);
            }
            Some((name, matches)) => return study::run(session, find(suite, name)?, matches),
            None => {}
        },
        Some((validate::CHILD, matches)) => {
            return validate::run_child(registry, &validate::ChildArgs::from_arg_matches(matches)?);
        }
        Some((REPORT, _)) if !cfg!(feature = "page") => anyhow::bail!("{REPORT}: {NO_PAGE}"),
        Some((name, _)) => {
            if let Some(sentence) = moved::said("command", &moved::COMMANDS, name) {
                anyhow::bail!(sentence);
            }
        }
    }
    match Command::from_arg_matches(matches)? {
        Command::Diff(args) => diff::run(&args, terminal),
        Command::Validate(args) => validate::run(registry, &args, terminal),
        Command::Rays(args) => rays::run(registry, &args, terminal),
        #[cfg(feature = "page")]
        Command::Report(args) => report::run(suite, &args, terminal),
        Command::Fetch(args) => fetch::run(&args, terminal),
        Command::Render(args) => render::run(registry, &args, terminal),
        Command::Golden(args) => golden::run(registry, &args, terminal),
        Command::List(args) => list::run(suite, &args, terminal),
        Command::Completions(args) => completions::run(suite, &args, terminal),
    }
}

fn find<'a>(suite: &'a Suite, study: &str) -> anyhow::Result<&'a Study> {
    suite.studies.find(study).ok_or_else(|| {
        if let Some(sentence) = moved::said("study", &moved::STUDIES, study) {
            return anyhow::anyhow!(sentence);
        }
        let names: Vec<&str> = suite.studies.iter().map(|study| study.name).chain([all::NAME, plan::NAME]).collect();
        let suggestion = suggestion(study, names.iter().copied());
        anyhow::anyhow!("there is no study {study:?}{suggestion}; there are: {}", names.join(", "))
    })
}
