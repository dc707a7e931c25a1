//! The command `sahara`.
//!
//! Results go to stdout, progress and errors to stderr. `sahara --help` lists the exit statuses of all commands.

mod accuracy;
mod bench;
mod compare;
mod compare_runs;
mod completions;
mod counts;
mod fetch;
mod golden;
mod hard;
mod list;
mod progress;
mod rays;
mod render;
mod replicate;
mod report;
mod sources;
mod study;
mod terminal;
mod validate;

use std::ffi::OsString;
use std::io;
use std::process::ExitCode;

use clap::{Parser, Subcommand};
use serde::{Deserialize, Serialize};

use crate::measure::program;
use crate::output::OutputError;
use crate::registry::Registry;
use crate::simd::Level;
use crate::study::guarded;
use terminal::{Colour, Terminal};

/// One rule for all commands; what a baseline is known to get wrong is no fault of a run.
const STATUSES: &str = "Exit status:
  0  right
  1  usage, or input or output that cannot be had
  2  wrong answers, or answers without an end
  3  a regression (bench --fail-on-regression)
  4  the samples do not tell whether there is a regression
  5  right, but for a structure that could not be built, panicked or could not take part
Wrong answers of a baseline from another project whose defects are documented are shown, cost it its time,
and do not change the status: 2 is for everything else. Tables name the defects.

`-` in place of a file to write is standard output; tables and messages go to standard error then.";

/// Benchmark, validate and image-test ray-tracing acceleration structures.
///
/// Without a command: `compare` on the built-in scenes.
#[derive(Debug, Parser)]
#[command(name = "sahara", version, max_term_width = 100, after_help = STATUSES)]
struct Cli {
    #[command(subcommand)]
    command: Option<Command>,
    /// When to use colour; `auto` asks the terminal and honours NO_COLOR
    #[arg(long, global = true, value_enum, default_value_t, value_name = "WHEN")]
    color: Colour,
    /// Show no progress and no warnings
    #[arg(long, short, global = true)]
    quiet: bool,
    /// Run on these instructions instead of the best ones here: portable, avx2 or avx512; the answers are the same
    #[arg(long, global = true)]
    level: Option<Level>,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Build, check, count and time every structure on every scene
    Compare(compare::Args),
    /// Time a small set again and again: keep runs as baselines, and find what became slower or wrong
    Bench(bench::Args),
    /// Hold two exported runs of `compare` against each other
    CompareRuns(compare_runs::Args),
    /// Measure the source report's tables again, and test its conclusion
    Replicate(replicate::Args),
    /// Hold every structure against a reference, hit for hit
    Validate(validate::Args),
    /// Record, import and show files of rays
    Rays(rays::Args),
    /// Write what runs have measured as a page, Markdown, LaTeX and tidy data
    Report(report::Args),
    /// Run an experiment with a question of its own
    Study(study::Args),
    /// How wrong, how fast: every structure over every triangle test, judged by exact arithmetic
    Accuracy(accuracy::Args),
    /// Put the hard cases to every structure, and say what each gets wrong
    Hard(hard::Args),
    /// Answer for one structure and one hard case; what `hard` runs in a process of its own
    #[command(name = hard::CHILD, hide = true)]
    HardAnswer(hard::ChildArgs),
    /// Count what no machine changes: nodes, leaves, references, overlap; steps and tests of rays
    Counts(counts::Args),
    /// Download the real meshes that scene files name, verified; licences are shown first
    Fetch(fetch::Args),
    /// Draw a picture
    Render(render::Args),
    /// Check or make the golden images
    Golden(golden::Args),
    /// Name the scenes, structures, workloads, views and triangle tests
    List,
    /// Print a completion script for a shell
    Completions(completions::Args),
}

/// What a command found.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum Verdict {
    Right,
    /// A structure gave wrong answers.
    Wrong,
    /// A structure could not be built or panicked; the others are right.
    Refused,
    /// A structure became slower.
    Regression,
    /// The samples do not tell whether a structure became slower.
    Undecided,
}

/// Runs the command line of this process over the structures of `registry`.
pub fn main(registry: Registry) -> ExitCode {
    run(&registry, std::env::args_os())
}

/// Said after a panic that no command has caught.
const PANIC: &str = "the panic above ended the command: if it is a structure's, leave that out, or find the mesh or ray with \
                     `sahara validate`; else it is a fault of sahara";

/// Runs `args`, the name of the program first, over the structures of `registry`.
pub fn run(registry: &Registry, args: impl IntoIterator<Item = OsString>) -> ExitCode {
    // The date of what is measured is that of its beginning.
    program::started();
    let cli = match Cli::try_parse_from(args) {
        Ok(cli) => cli,
        Err(message) => {
            // Help and version are answers, not errors; a reader that has gone away is no error either.
            let _ = message.print();
            return ExitCode::from(u8::from(message.use_stderr()));
        }
    };
    if let Some(level) = cli.level {
        level.choose();
    }
    let terminal = Terminal::new(cli.color, cli.quiet);
    let command = cli.command.unwrap_or_else(|| Command::Compare(compare::Args::default()));
    // What `hard` runs in a process of its own tells it of a panic by ending with one.
    let may_panic = matches!(command, Command::HardAnswer(_));
    let run = || match command {
        Command::Compare(args) => compare::run(registry, &args, &terminal),
        Command::Bench(args) => bench::run(registry, &args, &terminal),
        Command::CompareRuns(args) => compare_runs::run(&args, &terminal),
        Command::Replicate(args) => replicate::run(registry, &args, &terminal),
        Command::Report(args) => report::run(registry, &args, &terminal),
        Command::Validate(args) => validate::run(registry, &args, &terminal),
        Command::Rays(args) => rays::run(registry, &args, &terminal),
        Command::Study(args) => study::run(registry, &args, &terminal),
        Command::Accuracy(args) => accuracy::run(registry, &args, &terminal),
        Command::Hard(args) => hard::run(registry, &args, &terminal),
        Command::HardAnswer(args) => hard::run_child(registry, &args),
        Command::Counts(args) => counts::run(registry, &args, &terminal),
        Command::Fetch(args) => fetch::run(&args, &terminal),
        Command::Render(args) => render::run(registry, &args, &terminal),
        Command::Golden(args) => golden::run(registry, &args, &terminal),
        Command::List => list::run(registry, &terminal),
        Command::Completions(args) => completions::run(registry, &args, &terminal),
    };
    // A structure of another crate may panic where its command has nothing else to go on with.
    let found = if may_panic { run() } else { guarded(run).unwrap_or_else(|| Err(anyhow::anyhow!(PANIC))) };
    match found {
        Ok(Verdict::Right) => ExitCode::SUCCESS,
        Ok(Verdict::Wrong) => ExitCode::from(2),
        Ok(Verdict::Regression) => ExitCode::from(3),
        Ok(Verdict::Undecided) => ExitCode::from(4),
        Ok(Verdict::Refused) => ExitCode::from(5),
        Err(error) if is_broken_pipe(&error) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error:#}");
            ExitCode::from(1)
        }
    }
}

/// Whether the reader of our output has gone away, as `head` does.
fn is_broken_pipe(error: &anyhow::Error) -> bool {
    let of_file = error.downcast_ref::<OutputError>().and_then(|error| match error {
        OutputError::Write { cause, .. } => Some(cause),
        _ => None,
    });
    error.downcast_ref::<io::Error>().or(of_file).is_some_and(|error| error.kind() == io::ErrorKind::BrokenPipe)
}
