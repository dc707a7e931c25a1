//! The command `sahara`.
//!
//! Results go to stdout, progress and errors to stderr. `sahara --help` lists the exit statuses of all commands.

mod all;
mod compare;
mod completions;
mod diff;
#[cfg(test)]
mod documented;
pub(crate) mod exit_status;
mod fetch;
mod golden;
mod interrupt;
mod list;
mod plan;
mod progress;
mod rays;
mod render;
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
use crate::study::job::{self, Done, Job};
use crate::study::process::Processes;
use crate::study::{AnyStudy, Chosen, Status, Studies, sources};
use progress::OnTerminal;
use terminal::{Colour, Terminal};

const ABOUT: &str = "Benchmark, validate and image-test ray-tracing acceleration structures.";

const LONG_ABOUT: &str = "Benchmark, validate and image-test ray-tracing acceleration structures.

Without a command: `compare` on the built-in scenes.";

/// The structures and studies of a command.
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
    /// Run on these instructions instead of the best ones here: portable, avx2 or avx512, where this build has them; the answers are the same
    #[arg(long, global = true)]
    level: Option<Level>,
}

/// Options of the processes that a run starts.
#[derive(Debug, clap::Args)]
struct Process {
    /// Measure this case of a run, and say it in lines of JSON: how a run starts a process
    #[arg(long = job::OPTION, global = true, hide = true)]
    job: Option<Job>,
    /// Write that case into this file: a line of `study plan`
    #[arg(long = job::OUT, global = true, hide = true, requires = "job")]
    out: Option<PathBuf>,
}

/// What studies are run with.
struct Session<'a> {
    suite: &'a Suite,
    terminal: &'a Terminal,
    processes: Option<&'a Processes>,
}

impl<'a> Session<'a> {
    /// What starts a process for each case, unless all are to be measured in this one.
    fn processes(&self, common: &study::Common) -> Option<&'a Processes> {
        self.processes.filter(|_| !common.in_process)
    }
}

// The commands that are no study. No doc comment: clap would take it for what the whole command does.
#[derive(Debug, Subcommand)]
enum Command {
    /// Hold two exported runs of `compare` against each other; those of two machines by their ratios to obvhs
    Diff(diff::Args),
    /// Hold every structure against a reference, hit for hit
    Validate(Box<validate::Args>),
    /// Record, import and show files of rays; write rays with exact answers
    Rays(rays::Args),
    /// Write what runs have measured as a page, Markdown, LaTeX and tidy data
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

/// The others, by name.
const STUDY: &str = "study";

/// Commands that went, and what does their work.
const OLD: [(&str, &str); 5] = [
    ("bench", "`sahara compare --save-baseline NAME` and `sahara compare --baseline NAME`"),
    ("compare-runs", "`sahara diff A.json B.json`"),
    ("hard", "`sahara validate --hard CASE`"),
    ("counts", "`sahara study counts`"),
    ("accuracy", "`sahara study accuracy`"),
];

/// The commands that people are shown.
fn shown(studies: &Studies) -> clap::Command {
    let whole = clap::Command::new("sahara").version(env!("CARGO_PKG_VERSION")).max_term_width(100);
    let mut command = Global::augment_args(whole).about(ABOUT).long_about(LONG_ABOUT).after_help(exit_status::STATUSES);
    command = command.subcommands(studies.find(COMPARE).map(compare::command));
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
    let old = OLD.map(|(name, _)| clap::Command::new(name).hide(true).disable_help_flag(true).arg(rest()));
    command.subcommands(old)
}

/// Runs the command line of this process over structures, with the studies of this crate, or over a whole [`Suite`].
pub fn main(suite: impl Into<Suite>) -> ExitCode {
    interrupt::watch();
    run_with(&suite.into(), std::env::args_os(), Some(&Processes::new(std::env::args_os())))
}

const PANIC: &str = "the panic above ended the command: if it is a structure's, leave that out, or find the mesh or ray with \
                     `sahara validate`; else it is a fault of sahara";

/// Runs `args`, the name of the program first. They need not be those of this program, so all is measured in this process.
pub fn run(suite: &Suite, args: impl IntoIterator<Item = OsString>) -> ExitCode {
    run_with(suite, args, None)
}

fn run_with(suite: &Suite, args: impl IntoIterator<Item = OsString>, processes: Option<&Processes>) -> ExitCode {
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
    let terminal = Terminal::new(global.color, global.quiet);
    // What `validate --hard` runs in a process of its own tells it of a panic by ending with one.
    let may_panic = matches.subcommand_name() == Some(validate::CHILD);
    let session = Session { suite, terminal: &terminal, processes };
    let run = || match &process.job {
        Some(job) => answer_job(&session, &matches, job, process.out.as_deref()).map(|()| Status::Right),
        None => dispatch(&session, &matches, &global),
    };
    // A structure of another crate may panic where its command has nothing else to go on with.
    let found = if may_panic { Ok(run()) } else { catch_unwind(AssertUnwindSafe(run)) };
    exit_status::of(found.unwrap_or_else(|_| {
        panics::uncaught().iter().for_each(crate::output::tell);
        Err(anyhow::anyhow!(PANIC))
    }))
}

/// Names what clap does not.
fn not_text(args: &[OsString]) -> anyhow::Error {
    let names: Vec<String> = args.iter().filter(|arg| arg.to_str().is_none()).map(quoted).collect();
    anyhow::anyhow!("{} is not UTF-8 text: files and folders may have such names, but nothing else", names.join(" or "))
}

/// What a process with a job does, on the command line of the run that it is a part of.
fn answer_job(session: &Session, matches: &ArgMatches, job: &Job, out: Option<&Path>) -> anyhow::Result<()> {
    let &Session { suite, terminal, .. } = session;
    sources::load_only(&job.scene);
    job.cores.iter().for_each(|cores| keep_to(cores));
    let study = find(suite, &job.study)?;
    if let Some(out) = out {
        let done = study.write_job(chosen(matches)?, &suite.registry, job, out, &mut OnTerminal::of_job(terminal))?;
        match done {
            Done::Measured => {}
            Done::Before => {
                crate::output::tell(format_args!("{} holds this case already: nothing is measured.", out.escaped()))
            }
            Done::Meanwhile => {
                crate::output::tell(format_args!(
                    "{} has been written by another job meanwhile: its case is kept.",
                    out.escaped()
                ));
            }
        }
        return Ok(());
    }
    if let Some((COMPARE, matches)) = matches.subcommand() {
        return compare::answer_job(suite, matches, job);
    }
    study.answer_job(chosen(matches)?, &suite.registry, job)
}

/// Where the options of a study come from on a command line.
fn chosen(matches: &ArgMatches) -> anyhow::Result<Chosen<'_>> {
    Ok(match matches.subcommand() {
        None => Chosen::Defaults,
        Some((STUDY, matches)) => match matches.subcommand() {
            Some((all::NAME, matches)) => all::Args::from_arg_matches(matches)?.chosen(),
            Some((_, matches)) => Chosen::Matches(matches),
            None => anyhow::bail!("a job is of a study"),
        },
        Some((_, matches)) => Chosen::Matches(matches),
    })
}

fn dispatch(session: &Session, matches: &ArgMatches, global: &Global) -> anyhow::Result<Status> {
    let &Session { suite, terminal, .. } = session;
    let registry = &suite.registry;
    match matches.subcommand() {
        None => {
            let compare = suite.studies.find(COMPARE).ok_or_else(|| anyhow::anyhow!("name a command: see --help"))?;
            return study::run_as(session, compare, Chosen::Defaults, &study::Common::default());
        }
        Some((COMPARE, matches)) => return compare::run(session, matches),
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
        Some((REPLICATE, matches)) => return study::run(session, find(suite, REPLICATE)?, matches),
        Some((name, _)) => {
            if let Some((_, new)) = OLD.iter().find(|(old, _)| *old == name) {
                anyhow::bail!("`sahara {name}` is now {new}");
            }
        }
    }
    match Command::from_arg_matches(matches)? {
        Command::Diff(args) => diff::run(&args, terminal),
        Command::Report(args) => report::run(suite, &args, terminal),
        Command::Validate(args) => validate::run(registry, &args, terminal),
        Command::Rays(args) => rays::run(registry, &args, terminal),
        Command::Fetch(args) => fetch::run(&args, terminal),
        Command::Render(args) => render::run(registry, &args, terminal),
        Command::Golden(args) => golden::run(registry, &args, terminal),
        Command::List(args) => list::run(suite, &args, terminal),
        Command::Completions(args) => completions::run(suite, &args, terminal),
    }
}

fn find<'a>(suite: &'a Suite, study: &str) -> anyhow::Result<&'a dyn AnyStudy> {
    suite.studies.find(study).ok_or_else(|| {
        let names: Vec<&str> = suite.studies.iter().map(|study| study.name()).chain([all::NAME, plan::NAME]).collect();
        let suggestion = suggestion(study, names.iter().copied());
        anyhow::anyhow!("there is no study {study:?}{suggestion}; there are: {}", names.join(", "))
    })
}
