//! A structure asked in a process of its own, so that neither a panic nor an endless loop ends the run.

use std::io::{self, Read};
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::thread;
use std::time::{Duration, Instant};

use crate::accel::BuildError;
use crate::measure::SystemClock;
use crate::registry::{Choice, Registry};
use crate::simd::Level;
use crate::study::Status;
use crate::validate::hard_cases::{Answers, Failure, HardCase, ask, find};

/// The hidden command that a child runs.
pub const COMMAND: &str = "hard-answer";

#[derive(Debug, clap::Args)]
pub struct Args {
    /// Name of a hard case
    case: String,
    /// A structure, with keys that differ from their defaults
    structure: String,
    /// Rays at most
    #[arg(long)]
    rays: u32,
}

const PANICKED: i32 = 101;

const PAUSE: Duration = Duration::from_millis(5);

/// The child's side: answers on standard output.
///
/// # Errors
/// If the structure does not admit the mesh.
pub fn run(registry: &Registry, args: &Args) -> anyhow::Result<Status> {
    let (case, choice) = (find(&args.case)?, registry.choose(&args.structure)?);
    match ask(case, &choice.subject(), args.rays as usize, &SystemClock::start()) {
        Ok(answers) => {
            crate::output::print(&answers.to_bytes());
            Ok(Status::Right)
        }
        // The registry has caught it; the parent looks for the exit status of a panic.
        Err(BuildError::Panic) => std::panic::resume_unwind(Box::new("a builder panicked")),
        Err(refused) => Err(refused.into()),
    }
}

/// The parent's side: starts `program`, this same command, and waits for the answers to at most `rays` rays.
///
/// # Errors
/// The inner one if there are no answers, or not in time; the outer one if no process can be started.
pub fn answers(
    program: &Path,
    case: &HardCase,
    choice: &Choice,
    rays: u32,
    limit: Duration,
) -> io::Result<Result<Answers, Failure>> {
    let mut command = Command::new(program);
    command.args([COMMAND, case.name, &choice.label, "--rays", &rays.to_string(), "--level", Level::current().name()]);
    outcome(command, limit)
}

/// What comes of a child within the limit.
fn outcome(mut command: Command, limit: Duration) -> io::Result<Result<Answers, Failure>> {
    let mut child = command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn()?;

    // Empty both pipes at once: a full one would stop the child.
    let (mut out, mut err) = (child.stdout.take().expect("piped"), child.stderr.take().expect("piped"));
    let drain = |pipe: &mut dyn Read| -> io::Result<Vec<u8>> {
        let mut bytes = vec![];
        pipe.read_to_end(&mut bytes)?;
        Ok(bytes)
    };
    thread::scope(|scope| {
        let (out, err) = (scope.spawn(move || drain(&mut out)), scope.spawn(move || drain(&mut err)));
        let code = wait(&mut child, limit)?;
        let (out, err) = (out.join().expect("reads only")?, err.join().expect("reads only")?);
        Ok(match code {
            None => Err(Failure::Hang),
            Some(Some(0)) => Answers::from_bytes(&out).map_err(|_| Failure::Crash),
            Some(Some(1)) => {
                let sentence = String::from_utf8_lossy(&err);
                let sentence = sentence.trim().trim_start_matches("error: ").to_owned();
                let declined = sentence.starts_with("declined: ");
                Err(if declined { Failure::Declined(sentence) } else { Failure::Refused(sentence) })
            }
            Some(Some(PANICKED)) => Err(Failure::Panic),
            Some(_) => Err(Failure::Crash),
        })
    })
}

/// The exit code, nothing within if a signal ended the child; or nothing if it had to be killed.
fn wait(child: &mut Child, limit: Duration) -> io::Result<Option<Option<i32>>> {
    let start = Instant::now();
    loop {
        if let Some(status) = child.try_wait()? {
            return Ok(Some(status.code()));
        }
        if start.elapsed() > limit {
            child.kill()?;
            child.wait()?;
            return Ok(None);
        }
        thread::sleep(PAUSE);
    }
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;
    use crate::validate::hard_cases::Head;

    fn of(script: &str) -> Result<Answers, Failure> {
        let mut command = Command::new("/bin/sh");
        command.args(["-c", script]);
        let seconds = if script.contains("sleep") { 2 } else { 60 };
        outcome(command, Duration::from_secs(seconds)).unwrap()
    }

    #[test]
    fn every_end_of_a_child_has_its_name() {
        let head = Head::default();
        let bytes = String::from_utf8(Answers { head: head.clone(), hits: vec![] }.to_bytes()).unwrap();
        assert_eq!(of(&format!("printf '%s\\n' '{}'", bytes.trim_end())), Ok(Answers { head, hits: vec![] }));
        assert_eq!(of("exec sleep 600"), Err(Failure::Hang));
        assert_eq!(of("echo 'thread main panicked' >&2; exit 101"), Err(Failure::Panic));
        assert_eq!(of("kill -9 $$"), Err(Failure::Crash));
        assert_eq!(of("echo nonsense"), Err(Failure::Crash));
        assert_eq!(of("exit 3"), Err(Failure::Crash));
        assert_eq!(of("echo 'error: too large' >&2; exit 1"), Err(Failure::Refused("too large".into())));
    }

    #[test]
    fn a_child_that_says_much_is_not_stopped_by_a_full_pipe() {
        assert_eq!(of("yes | head -c 1000000 >&2; exit 101"), Err(Failure::Panic));
    }
}
