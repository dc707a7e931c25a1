//! Runs hard cases in child processes, because a structure may panic or hang.

use std::io;
use std::process::{Command, Output};
use std::time::Duration;

use crate::accel::BuildError;
use crate::cli::validate;
use crate::measure::process_group::{end_with_parent, output_within};
use crate::measure::{SystemClock, program};
use crate::registry::{Choice, Registry};
use crate::request::{self, RUNNER_LIMIT, Seconds};
use crate::simd::Level;
use crate::study::Status;
use crate::validate::hard_cases::{Answers, Failure, HardCase, find, run};

pub const COMMAND: &str = "hard-answer";

#[derive(Debug, clap::Args)]
pub struct Args {
    /// Name of a hard case
    name: String,
    #[arg(required_unless_present = "runner")]
    structure: Option<String>,
    /// Command of a runner, instead of a structure
    #[arg(long, allow_hyphen_values = true)]
    runner: Option<String>,
    #[arg(long, default_value_t = RUNNER_LIMIT)]
    runner_limit: Seconds,
    /// Maximum number of rays
    #[arg(long)]
    rays: u32,
}

const PANICKED: i32 = 101;

/// Runs in the child process. Writes the results to standard output.
pub fn run_child(registry: &Registry, args: &Args) -> anyhow::Result<Status> {
    end_with_parent();
    let case = find(&args.name)?;
    let choice = match (&args.runner, &args.structure) {
        (Some(command), _) => request::runner(command, args.runner_limit.seconds())?,
        (None, Some(structure)) => registry.choose(structure)?,
        (None, None) => anyhow::bail!("a structure or a runner is needed"),
    };
    let answers = match run(case, &choice.subject(), args.rays as usize, &SystemClock::start()) {
        // Panic again, because the parent process recognises the exit status of a panic.
        Err(BuildError::Panic) => std::panic::resume_unwind(Box::new("a builder panicked")),
        answers => answers?,
    };
    crate::output::print(&serde_json::to_vec(&answers)?);
    Ok(Status::Right)
}

/// Runs in the parent process. A structure has one time limit for the whole case. A runner has a time limit for each
/// reply. The outer result is an error only if the child process could not be run.
pub fn answers(
    case: &HardCase,
    choice: &Choice,
    rays: u32,
    limits: &validate::Args,
) -> io::Result<Result<Answers, Failure>> {
    let (rays, level, reply) = (rays.to_string(), Level::current().name(), limits.runner_limit.to_string());
    let (structure, limit) = match choice.command() {
        Some(command) => (vec!["--runner", command, "--runner-limit", &reply], Duration::MAX),
        None => (vec![&*choice.label], limits.limit.duration()),
    };
    let mut command = Command::new(program::executable());
    command.args([COMMAND, case.name, "--rays", &rays, "--level", level]).args(structure);
    Ok(outcome(output_within(&mut command, limit)?))
}

fn outcome(output: Option<Output>) -> Result<Answers, Failure> {
    let output = output.ok_or(Failure::Hang)?;
    match output.status.code() {
        Some(0) => serde_json::from_slice(&output.stdout).map_err(|_| Failure::Crash),
        Some(1) => {
            let sentence = String::from_utf8_lossy(&output.stderr);
            // Take the last error, because earlier lines may come from a runner.
            let error = sentence.lines().rev().find_map(|line| line.strip_prefix("error: "));
            let sentence = error.unwrap_or_else(|| sentence.trim()).to_owned();
            let declined = sentence.starts_with("declined: ");
            Err(if declined { Failure::Declined(sentence) } else { Failure::Refused(sentence) })
        }
        Some(PANICKED) => Err(Failure::Panic),
        _ => Err(Failure::Crash),
    }
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;

    #[test]
    fn every_end_of_a_child_has_its_name() {
        let answers = Answers { build_ns: 7, ..Answers::default() };
        let text = serde_json::to_string(&answers).unwrap();
        for (script, expected) in [
            (&*format!("printf '%s' '{text}'"), Ok(answers)),
            ("exec sleep 600", Err(Failure::Hang)),
            ("echo 'thread main panicked' >&2; exit 101", Err(Failure::Panic)),
            ("kill -9 $$", Err(Failure::Crash)),
            ("echo nonsense", Err(Failure::Crash)),
            ("exit 3", Err(Failure::Crash)),
            ("echo 'error: too large' >&2; exit 1", Err(Failure::Refused("too large".into()))),
            ("echo 'I start' >&2; echo 'error: too large' >&2; exit 1", Err(Failure::Refused("too large".into()))),
            ("echo 'declined: any hit' >&2; exit 1", Err(Failure::Declined("declined: any hit".into()))),
        ] {
            let limit = Duration::from_secs(if script.contains("sleep") { 1 } else { 60 });
            let output = output_within(Command::new("/bin/sh").args(["-c", script]), limit).unwrap();
            assert_eq!(outcome(output), expected, "{script}");
        }
    }
}
