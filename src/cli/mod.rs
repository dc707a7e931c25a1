//! The command `sahara`.

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
#[cfg(test)]
mod wording;

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
use crate::request::{MEASURING, OUTPUT};
use crate::simd::Level;
use crate::study::process::{self, build_watch, measure_for_run, measure_into};
use crate::study::{Case, Status, Studies, Study};
use progress::OnTerminal;
use terminal::{Colour, Terminal};

/// The template of `sahara --help`. The help and a shell prompt must fit into 80 x 24 characters. The template
/// therefore omits the global options.
const SCREEN: &str = "\
{about}

{usage-heading} {usage}

Commands (`sahara COMMAND --help` explains options and exit statuses):
{subcommands}{after-help}";

const EXAMPLES: &str = "\
Examples:
  sahara compare mesh.obj -s sah-bvh -s obvhs-bvh2  # measure times, check hits
  sahara validate mesh.obj --adversarial            # check hits only
  sahara golden compare expected/ actual/           # compare rendered images";

pub struct Suite {
    pub registry: Registry,
    pub studies: Studies,
}

impl From<Registry> for Suite {
    fn from(registry: Registry) -> Self {
        Self { registry, studies: Studies::builtin() }
    }
}

/// This display order puts global options after the options of each command.
const GLOBAL: usize = 900;

/// Options of all commands.
#[derive(Debug, clap::Args)]
struct Global {
    /// Print notes, and table columns that are hidden by default
    #[arg(long, global = true, help_heading = OUTPUT, display_order = GLOBAL)]
    verbose: bool,
    /// Hide progress and warnings
    #[arg(long, short, global = true, hide_short_help = true, help_heading = OUTPUT, display_order = GLOBAL)]
    quiet: bool,
    /// When to use colour: auto (on a terminal, unless NO_COLOR is set), always or never
    #[arg(long, global = true, hide_short_help = true, help_heading = OUTPUT, display_order = GLOBAL)]
    #[arg(value_enum, default_value_t, value_name = "WHEN", hide_possible_values = true)]
    color: Colour,
    /// Instruction set: portable, avx2 or avx512, if this build and the processor support it; hits are the same with
    /// each [default: the best one]
    #[arg(long, global = true, hide_short_help = true, help_heading = MEASURING, display_order = GLOBAL)]
    level: Option<Level>,
}

// Options of the processes that a run starts. Clap would show a doc comment of `Process` as the description of
// `sahara`.
#[derive(Debug, clap::Args)]
struct Process {
    /// Measure this case (used by runs and schedulers)
    #[arg(id = "process-case", long = process::CASE, global = true, hide = true, requires = "process-out", value_parser = read_case)]
    case: Option<Case>,
    /// Write the measured case into this file
    #[arg(id = "process-out", long = process::OUT, global = true, hide = true, requires = "process-case")]
    out: Option<PathBuf>,
    /// Report progress on standard output and wait for replies
    #[arg(long = process::LISTEN, global = true, hide = true, requires = "process-case")]
    listen: bool,
    /// Pin to these cores
    #[arg(long = process::CORES, global = true, hide = true, requires = "process-case", value_delimiter = ',')]
    cores: Vec<usize>,
}

fn read_case(text: &str) -> Result<Case, String> {
    serde_json::from_str(text).map_err(|cause| format!("this is not a case of this version of sahara: {cause}"))
}

struct Session<'a> {
    suite: &'a Suite,
    terminal: &'a Terminal,
    /// Each case is measured by a new process that receives these options. If `None`, this process measures all cases.
    processes: Option<&'a [OsString]>,
}

// The commands that are not studies. Clap would show a doc comment of `Command` as the description of `sahara`.
#[derive(Debug, Subcommand)]
enum Command {
    /// Compare two runs, or fail on a regression
    Diff(diff::Args),
    /// Check every structure's hits against a reference
    Validate(Box<validate::Args>),
    /// Record, import and print ray files; write a corpus of meshes, rays and exact hits
    #[command(subcommand)]
    Rays(rays::Action),
    /// Write the results of runs as a web page, Markdown and CSV
    #[cfg(feature = "page")]
    Report(report::Args),
    /// Download and verify the real meshes of scenes
    Fetch(fetch::Args),
    /// Render a picture of a scene
    Render(render::Args),
    /// Check or update golden images, or compare any pictures
    #[command(subcommand)]
    Golden(golden::Action),
    /// List scenes, structures and studies, or a structure's options
    List(list::Args),
    /// Print a shell completion script or the manual page
    Completions(completions::Args),
}

const COMPARE: &str = "compare";
const REPLICATE: &str = "replicate";

const STUDY: &str = "study";
const REPORT: &str = "report";

pub(crate) const NO_PAGE: &str = "this sahara was built without the feature `page`: rebuild it with `--features page`";

/// The commands that appear in the help.
fn shown(studies: &Studies) -> clap::Command {
    let whole = clap::Command::new("sahara").version(env!("CARGO_PKG_VERSION")).max_term_width(100);
    let command = Global::augment_args(whole)
        // Replace the description that `augment_args` took from the doc comment of `Global`.
        .about("Benchmark, validate and image-test ray-tracing acceleration structures.")
        .long_about(None)
        .override_usage("sahara [COMMAND] [OPTIONS]  (no command: compare on the built-in scenes)")
        .help_template(SCREEN)
        .after_help(EXAMPLES)
        .subcommands([COMPARE, REPLICATE].into_iter().filter_map(|name| studies.find(name)).map(study::command));
    let listed = clap::Command::new(STUDY)
        .about("Run a study, or plan its jobs for a cluster")
        .subcommand_required(true)
        .arg_required_else_help(true)
        // The function `find` reports unknown studies.
        .allow_external_subcommands(true)
        .subcommand(all::Args::augment_args(clap::Command::new(all::NAME)))
        .subcommand(plan::Args::augment_args(clap::Command::new(plan::NAME)))
        .subcommands(studies.iter().map(study::command));
    Command::augment_subcommands(command.subcommand(listed))
}

/// The complete command line, including hidden commands and hidden options.
fn command(studies: &Studies) -> clap::Command {
    let child = clap::Command::new(validate::CHILD).hide(true);
    let command = Process::augment_args(shown(studies)).subcommand(validate::ChildArgs::augment_args(child));
    let rest = || clap::Arg::new("rest").num_args(0..).trailing_var_arg(true).allow_hyphen_values(true);
    let old = |(name, _): &(&'static str, _)| clap::Command::new(*name).hide(true).disable_help_flag(true).arg(rest());
    let command = command.subcommands(moved::COMMANDS.iter().map(old));
    let command = if cfg!(feature = "page") { command } else { command.subcommand(old(&(REPORT, NO_PAGE))) };
    let mut command = command.mut_subcommands(with_statuses);
    // `build` adds the command `help`. Hide this command to shorten the output of `sahara --help`.
    command.build();
    command.mut_subcommand("help", |help| help.hide(true))
}

fn with_statuses(command: clap::Command) -> clap::Command {
    let has_end = command.get_after_help().is_some();
    let command = command.mut_subcommands(with_statuses);
    if has_end { command } else { command.after_long_help(exit_status::STATUSES) }
}

/// Runs the command line of this process. A [`Registry`] is converted into a suite with the built-in studies.
pub fn main(suite: impl Into<Suite>) -> ExitCode {
    interrupt::watch();
    run_with(&suite.into(), std::env::args_os(), true)
}

const PANIC: &str = "the panic above ended the command: if a structure caused it, omit the structure, or find the mesh or ray with \
                     `sahara validate`; otherwise it is a bug in sahara";

/// Runs the command line `args`. The first argument is the name of the program. All cases are measured in this process.
/// A separate process would run the calling program, which may not accept the option `--case`.
pub fn run(suite: &Suite, args: impl IntoIterator<Item = OsString>) -> ExitCode {
    run_with(suite, args, false)
}

fn run_with(suite: &Suite, args: impl IntoIterator<Item = OsString>, starts_processes: bool) -> ExitCode {
    // The first call of `started` sets the date of all measurements.
    program::started();
    let args: Vec<OsString> = args.into_iter().collect();
    let parsed = command(&suite.studies).try_get_matches_from(&args);
    let options = |matches| Ok((Global::from_arg_matches(&matches)?, Process::from_arg_matches(&matches)?, matches));
    let (global, process, matches) = match parsed.and_then(options) {
        Ok(parsed) => parsed,
        Err(message) if message.kind() == ErrorKind::InvalidUtf8 => return exit_status::of(Err(not_text(&args))),
        Err(message) => return exit_status::print_clap_message(message),
    };
    if let Some(level) = global.level {
        level.choose();
    }
    let terminal = Terminal::new(global.color, global.quiet, global.verbose);
    // Do not catch a panic in a child of `validate --hard`. The parent process detects the panic by the exit status.
    let may_panic = matches.subcommand_name() == Some(validate::CHILD);
    let level = global.level.iter().flat_map(|level| ["--level", level.name()]).map(OsString::from);
    let processes: Option<Vec<OsString>> = starts_processes.then(|| level.collect());
    let session = Session { suite, terminal: &terminal, processes: processes.as_deref() };
    let run = || match (&process.case, &process.out) {
        (Some(case), Some(out)) => measure_case(&session, &process, case, out, args.clone()),
        _ => dispatch(&session, &matches, &global).inspect(|_| terminal.print_note_count()),
    };
    let found = if may_panic { Ok(run()) } else { catch_unwind(AssertUnwindSafe(run)) };
    interrupt::wait_for_end();
    exit_status::of(found.unwrap_or_else(|_| {
        panics::uncaught().iter().for_each(crate::output::print_to_stderr);
        Err(anyhow::anyhow!(PANIC))
    }))
}

fn not_text(args: &[OsString]) -> anyhow::Error {
    let names: Vec<String> = args.iter().filter(|arg| arg.to_str().is_none()).map(quoted).collect();
    anyhow::anyhow!("{} is not UTF-8 text: only names of files and folders may contain such bytes", names.join(" or "))
}

fn measure_case(
    &Session { suite, terminal, .. }: &Session,
    process: &Process,
    case: &Case,
    out: &Path,
    args: Vec<OsString>,
) -> anyhow::Result<Status> {
    if !process.cores.is_empty() {
        keep_to(&process.cores);
    }
    let watch = build_watch(case, args);
    if process.listen {
        measure_for_run(case, out, &suite.registry, &watch)?;
        return Ok(Status::Right);
    }
    if let Some(why) = measure_into(case, out, &suite.registry, &watch, &mut OnTerminal::new(terminal, true))? {
        crate::output::print_to_stderr(format_args!("{} {why}", out.escaped()));
    }
    Ok(Status::Right)
}

fn dispatch(session: &Session, matches: &ArgMatches, global: &Global) -> anyhow::Result<Status> {
    let &Session { suite, terminal, .. } = session;
    let registry = &suite.registry;
    match matches.subcommand() {
        None => {
            let compare = suite.studies.find(COMPARE).ok_or_else(|| anyhow::anyhow!("give a command: see --help"))?;
            return study::run_as(session, compare, &compare.defaults(), &study::Common::default());
        }
        Some((name @ (COMPARE | REPLICATE), matches)) => return study::run(session, find(suite, name)?, matches),
        Some((STUDY, matches)) => {
            return match matches.subcommand().expect("clap asks for a study") {
                (all::NAME, matches) => all::run(session, &all::Args::from_arg_matches(matches)?),
                (plan::NAME, matches) => plan::run(session, &plan::Args::from_arg_matches(matches)?, global.level),
                (name, matches) => study::run(session, find(suite, name)?, matches),
            };
        }
        Some((validate::CHILD, matches)) => {
            return validate::run_child(registry, &validate::ChildArgs::from_arg_matches(matches)?);
        }
        Some((REPORT, _)) if !cfg!(feature = "page") => anyhow::bail!("{REPORT}: {NO_PAGE}"),
        Some((name, _)) => moved::check("command", &moved::COMMANDS, name)?,
    }
    match Command::from_arg_matches(matches)? {
        Command::Diff(args) => diff::run(&args, terminal),
        Command::Validate(args) => validate::run(registry, &args, terminal),
        Command::Rays(action) => rays::run(registry, &action, terminal),
        #[cfg(feature = "page")]
        Command::Report(args) => report::run(suite, &args, terminal),
        Command::Fetch(args) => fetch::run(&args, terminal),
        Command::Render(args) => render::run(registry, &args, terminal),
        Command::Golden(action) => golden::run(registry, &action, terminal),
        Command::List(args) => list::run(suite, &args, terminal),
        Command::Completions(args) => completions::run(suite, &args, terminal),
    }
}

fn find<'a>(suite: &'a Suite, study: &str) -> anyhow::Result<&'a Study> {
    if let Some(known) = suite.studies.find(study) {
        return Ok(known);
    }
    moved::check("study", &moved::STUDIES, study)?;
    let names: Vec<&str> = suite.studies.iter().map(|study| study.name).chain([all::NAME, plan::NAME]).collect();
    let suggestion = suggestion(study, names.iter().copied());
    anyhow::bail!("there is no study {study:?}{suggestion}; the studies are: {}", names.join(", "))
}
