//! Measures a case in a separate process.
//!
//! Each process has a different memory layout. Only samples from several processes show how much the memory layout
//! affects the measured speed ([`interval`](mod@crate::measure::interval)).
//!
//! A process with the options `--case JSON --out FILE` measures one case. With `--listen`, the process also writes
//! messages to standard output. A message is JSON on one line. The process waits for a reply to each stage message.
//! So the parent process is idle while the process takes times.
//! Structures can also print to standard output. The parent process copies the output of structures to standard error.

use std::ffi::OsString;
use std::io::{self, BufRead, BufReader, Write};
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError, Weak};
use std::thread;
use std::time::Duration;

use serde::{Deserialize, Serialize};

use super::journal::{CaseFile, JournalError};
use super::measure::{BuildWatch, Prepared, measure};
use super::{Case, Screen, Stage, StudyError};
use crate::measure::{Provenance, SystemClock, process_group, program};
use crate::registry::Registry;

pub const CASE: &str = "case";
pub const OUT: &str = "out";
pub const LISTEN: &str = "listen";
pub const CORES: &str = "cores";

#[derive(Serialize, Deserialize)]
enum Message<'a> {
    Stage(#[serde(borrow)] Stage<'a>),
    Failed { sentence: String, of_one_scene: bool, wrong_answer: bool },
}

/// The mark before the JSON of a message.
const MARK: &str = "\u{1e}case ";

/// The threads of the new process are bound to `cores`.
pub fn measure_apart(
    options: &[OsString],
    case: &Case,
    out: &Path,
    cores: Option<&[usize]>,
    progress: &mut dyn FnMut(Stage),
) -> Result<(), StudyError> {
    let failure = |cause: String| StudyError::Process { key: case.key(), cause };
    let text = serde_json::to_string(case).expect("a case has text keys");
    let mut command = Command::new(program::executable());
    command.args(options).arg(format!("--{CASE}={text}")).arg(format!("--{OUT}")).arg(out);
    command.arg(format!("--{LISTEN}"));
    let cores = cores.map(|cores| cores.iter().map(ToString::to_string).collect::<Vec<_>>().join(","));
    command.args(cores.map(|cores| format!("--{CORES}={cores}")));
    process_group::lead_process_group(&mut command);
    // Runners write temporary files to `scratch`. `scratch` is removed even if the new process is killed.
    let has_programs = case.structures.iter().any(|own| own.runner.is_some());
    let scratch = if has_programs { tempfile::Builder::new().prefix("sahara-").tempdir().ok() } else { None };
    command.envs(scratch.iter().flat_map(|folder| ["TMPDIR", "TMP", "TEMP"].map(|name| (name, folder.path()))));
    let child = command.stdin(Stdio::piped()).stdout(Stdio::piped()).spawn();
    let mut child = child.map_err(|cause| failure(format!("it cannot be started: {cause}")))?;
    let (input, output) = (child.stdin.take(), child.stdout.take());
    let child = Guard::new(child);
    let mut input = input.expect("it has an input");
    for line in BufReader::new(output.expect("it has an output")).split(b'\n') {
        let line = line.map_err(|cause| failure(cause.to_string()))?;
        let line = String::from_utf8_lossy(&line);
        let Some((own, message)) = line.split_once(MARK) else {
            crate::output::print_to_stderr(&line);
            continue;
        };
        let _ = write!(io::stderr(), "{own}");
        match serde_json::from_str(message).map_err(|cause| failure(format!("bad message {message:?}: {cause}")))? {
            Message::Stage(stage) => progress(stage),
            Message::Failed { sentence, of_one_scene, wrong_answer } => {
                return Err(StudyError::Reported { sentence, of_one_scene, wrong_answer });
            }
        }
        // The write fails if the new process has ended. The exit status is checked after the loop.
        let _ = writeln!(input);
    }
    // A blocking wait would hold the lock. Another thread can call `end`, which needs the lock.
    let status = loop {
        if let Some(status) = locked(&child.0).try_wait().map_err(|cause| failure(cause.to_string()))? {
            break status;
        }
        thread::sleep(Duration::from_millis(1));
    };
    if status.success() && out.exists() {
        return Ok(());
    }
    Err(failure(format!("it ended without a reply ({status})")))
}

/// A child process that is killed when the guard is dropped.
struct Guard(Arc<Mutex<Child>>);

/// The most recently started child process.
static LAST: Mutex<Weak<Mutex<Child>>> = Mutex::new(Weak::new());

static ENDED: AtomicBool = AtomicBool::new(false);

fn locked<T>(mutex: &Mutex<T>) -> std::sync::MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

impl Guard {
    fn new(child: Child) -> Self {
        let child = Arc::new(Mutex::new(child));
        *locked(&LAST) = Arc::downgrade(&child);
        if ENDED.load(Ordering::SeqCst) {
            end();
        }
        Self(child)
    }
}

impl Drop for Guard {
    fn drop(&mut self) {
        let mut child = locked(&self.0);
        process_group::end(&mut child);
        let _ = child.wait();
    }
}

/// Kills the running child process. Child processes that start later are killed at once.
pub fn end() {
    ENDED.store(true, Ordering::SeqCst);
    if let Some(child) = locked(&LAST).upgrade() {
        process_group::end(&mut locked(&child));
    }
}

/// Returns `None` if this call writes the case to `out`. Returns a message if `out` already contains the case. An error
/// leaves `out` unchanged.
pub fn measure_into(
    case: &Case,
    out: &Path,
    registry: &Registry,
    watch: &BuildWatch,
    screen: &mut dyn Screen,
) -> anyhow::Result<Option<&'static str>> {
    let check_same = || -> anyhow::Result<()> {
        anyhow::ensure!(CaseFile::read(out)?.case.is_same(case), JournalError::Other(out.into()));
        Ok(())
    };
    if out.exists() {
        return check_same().map(|()| Some("already contains this case: nothing is measured."));
    }
    let file = CaseFile::place(out)?;
    let prepared = Prepared::new(case, registry, None)?;
    let command = case.command.clone();
    let provenance = Provenance { process_per_epoch: true, command, ..Provenance::of(&prepared.threads) };
    // On an unwatched screen, a warning would be overlooked.
    if let Some(cause) = provenance.too_many_threads().filter(|_| !screen.is_watched()) {
        return Err(StudyError::Case { key: case.key(), cause }.into());
    }
    screen.begin(case.work());
    screen.case(&format!("{}, {}", case.study, case.title()), case.work());
    let epoch = measure(case, &prepared, &SystemClock::start(), watch, &mut |stage| screen.stage(&stage))?;
    screen.end();
    if CaseFile::write(&file, &provenance, case, &epoch)? {
        return Ok(None);
    }
    check_same().map(|()| Some("was written by another process in the meantime: its case is kept."))
}

/// Calls [`measure_into`] and sends progress and failure to the parent process.
pub fn measure_for_run(case: &Case, out: &Path, registry: &Registry, watch: &BuildWatch) -> io::Result<()> {
    // A process that outlives its parent process would disturb later measurements.
    process_group::end_with_parent();
    let Err(error) = measure_into(case, out, registry, watch, &mut ListeningRun) else { return Ok(()) };
    let known = error.downcast_ref::<StudyError>();
    say(&Message::Failed {
        sentence: format!("{error:#}"),
        of_one_scene: known.is_none_or(StudyError::is_of_one_scene),
        wrong_answer: known.is_some_and(StudyError::is_wrong_hit),
    })
}

struct ListeningRun;

impl Screen for ListeningRun {
    fn stage(&mut self, stage: &Stage) {
        let reply =
            say(&Message::Stage(stage.clone())).and_then(|()| io::stdin().lock().read_until(b'\n', &mut vec![]));
        if !matches!(reply, Ok(1..)) {
            // A missing reply means that the parent process has ended.
            std::process::exit(1);
        }
    }

    fn is_watched(&self) -> bool {
        true
    }
}

fn say(message: &Message) -> io::Result<()> {
    let line = serde_json::to_string(message).expect("a message has text keys");
    let mut out = io::stdout().lock();
    writeln!(out, "{MARK}{line}")?;
    out.flush()
}

/// If a build exceeds the limit, the returned watch restarts this program. The restarted program skips the structure. A
/// running build cannot be interrupted.
pub fn build_watch(case: &Case, args: Vec<OsString>) -> BuildWatch {
    let Some(limit) = case.settings.build_limit_s else { return BuildWatch::default() };
    let case = case.clone();
    let again = move |structure: usize| {
        let mut case = case.clone();
        let reason = format!("its build takes more than {limit} s: raise --build-limit, or set it to none");
        case.structures[structure].skipped = Some(reason);
        let text = serde_json::to_string(&case).expect("a case has text keys");
        let is_other = |arg: &&OsString| !arg.to_string_lossy().starts_with(&format!("--{CASE}="));
        let mut command = Command::new(program::executable());
        command.args(args.iter().skip(1).filter(is_other)).arg(format!("--{CASE}={text}"));
        replace(command);
    };
    BuildWatch::new(Duration::from_secs_f64(limit), again)
}

#[cfg(unix)]
fn replace(mut command: Command) {
    use std::os::unix::process::CommandExt;
    let cause = command.exec();
    crate::output::print_error(format_args!("this program cannot be started again: {cause}"));
    std::process::exit(1);
}

#[cfg(not(unix))]
fn replace(mut command: Command) {
    let status = command.status().ok().and_then(|status| status.code());
    std::process::exit(status.unwrap_or(1));
}

#[cfg(test)]
mod tests {
    use super::super::case::tests::example;
    use super::*;

    #[test]
    fn a_process_that_ends_without_an_answer_is_one_sentence() {
        // The test program does not know this option.
        let options = ["--no-such-option".into()];
        let out = tempfile::tempdir().unwrap();
        let case = example("Cube", 0, &["sah-kd"]);
        let error = measure_apart(&options, &case, &out.path().join("a.json"), None, &mut |_| ()).unwrap_err();
        let sentence = error.to_string();
        assert!(sentence.contains("Cube epoch 0") && sentence.contains("without a reply"), "{sentence}");
        assert!(error.is_of_one_scene() && !error.is_wrong_hit());
    }
}
