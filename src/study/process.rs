//! A case in a process of its own.
//!
//! Where the system puts a program, its stack and its heap can change the speed of a structure by some percent, for as
//! long as the process lives: only samples from several processes say by how much (Mytkowicz et al., Producing Wrong Data
//! Without Doing Anything Obviously Wrong!, 2009; Kalibera and Jones, Rigorous Benchmarking in Reasonable Time, 2013).
//!
//! The process is this program with a case and a file, `--case JSON --out FILE`: it measures the case and writes the file,
//! whoever started it, a run or a cluster's scheduler. A run that listens (`--listen`) reads what the process is doing, a
//! marked line of JSON each, from its standard output. After each line the process waits for one in answer: so the run
//! does nothing while the process times. Other lines are a structure's own, and go to standard error.

use std::ffi::OsString;
use std::io::{self, BufRead, BufReader, Write};
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError, Weak};
use std::thread;
use std::time::Duration;

use serde::{Deserialize, Serialize};

use super::case::Case;
use super::journal::CaseFile;
use super::measure::{BuildWatch, Prepared, measure};
use super::{Screen, Stage, StudyError};
use crate::measure::{Provenance, SystemClock, process_group, program};
use crate::registry::Registry;

/// The options that make a process measure a case.
pub const CASE: &str = "case";
pub const OUT: &str = "out";
pub const LISTEN: &str = "listen";
pub const CORES: &str = "cores";

/// A line of a process.
#[derive(Serialize, Deserialize)]
enum Message<'a> {
    Stage(#[serde(borrow)] Stage<'a>),
    Failed { sentence: String, of_one_scene: bool, wrong_answer: bool },
}

/// How processes are started.
#[derive(Clone, Debug, Default)]
pub struct Processes {
    /// Options of this one that each of them gets, such as the level of instructions.
    pub options: Vec<OsString>,
}

/// What the lines of a process begin with.
const MARK: &str = "\u{1e}case ";

impl Processes {
    /// Has a process measure a case and write the file `out`. Its threads are bound to `cores`, where they are known.
    ///
    /// # Errors
    /// As the measuring of the case, and if the process cannot be started or ends without an answer.
    pub fn measure(
        &self,
        case: &Case,
        out: &Path,
        cores: Option<&[usize]>,
        progress: &mut dyn FnMut(Stage),
    ) -> Result<(), StudyError> {
        let failure = |cause: String| StudyError::Process { key: case.key(), cause };
        let text = serde_json::to_string(case).expect("a case has text keys");
        let mut command = Command::new(program::executable());
        command.args(&self.options).arg(format!("--{CASE}={text}")).arg(format!("--{OUT}")).arg(out);
        command.arg(format!("--{LISTEN}"));
        if let Some(cores) = cores {
            let cores: Vec<String> = cores.iter().map(ToString::to_string).collect();
            command.arg(format!("--{CORES}={}", cores.join(",")));
        }
        process_group::set_apart(&mut command);
        // Programs that are timed have files there: what is left when the process is ended goes with the folder.
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
                crate::output::tell(&line);
                continue;
            };
            let _ = write!(io::stderr(), "{own}");
            match serde_json::from_str(message).map_err(|cause| failure(format!("it said {message:?}: {cause}")))? {
                Message::Stage(stage) => progress(stage),
                Message::Failed { sentence, of_one_scene, wrong_answer } => {
                    return Err(StudyError::Reported { sentence, of_one_scene, wrong_answer });
                }
            }
            // A process that has ended already is known by what it has said, or how it ended.
            let _ = writeln!(input);
        }
        // Others may end it meanwhile.
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
}

/// A process that does not outlive its use.
struct Guard(Arc<Mutex<Child>>);

/// The last one that was started.
static LAST: Mutex<Weak<Mutex<Child>>> = Mutex::new(Weak::new());

/// Whether what measures was to end.
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
        // It has ended, or nobody listens any more.
        let mut child = locked(&self.0);
        process_group::end(&mut child);
        let _ = child.wait();
    }
}

/// Ends the process that measures, if one does: the run is told that it has ended without an answer.
pub fn end() {
    ENDED.store(true, Ordering::SeqCst);
    if let Some(child) = locked(&LAST).upgrade() {
        process_group::end(&mut locked(&child));
    }
}

/// What a process with a case and a file comes to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Written {
    Now,
    /// It had been measured before.
    Before,
    /// Another process has measured it meanwhile.
    Meanwhile,
}

/// Measures a case and writes the file `out`, unless it is there.
///
/// # Errors
/// If the file cannot be written or holds anything else, there are fewer cores than threads, or nothing can be measured:
/// then it is as it was.
pub fn measure_into(
    case: &Case,
    out: &Path,
    registry: &Registry,
    watch: &BuildWatch,
    screen: &mut dyn Screen,
) -> anyhow::Result<Written> {
    let there = || -> anyhow::Result<bool> {
        if !out.exists() {
            return Ok(false);
        }
        let file = CaseFile::read(out)?;
        anyhow::ensure!(file.case.is_same(case), super::journal::JournalError::Other(out.into()));
        Ok(true)
    };
    if there()? {
        return Ok(Written::Before);
    }
    let file = CaseFile::place(out)?;
    let prepared = Prepared::new(case, registry, None)?;
    let command = case.command.clone();
    let provenance = Provenance { process_per_epoch: true, command, ..Provenance::of(&prepared.threads) };
    // A run warns of it. Nobody reads the logs of all jobs, and a file that is there is not measured again.
    if let Some(cause) = provenance.too_many_threads().filter(|_| !screen.is_watched()) {
        return Err(StudyError::Case { key: case.key(), cause }.into());
    }
    screen.begin(case.work());
    screen.case(&format!("{}, {}", case.study, case.title()), case.work());
    let epoch = measure(case, &prepared, &SystemClock::start(), watch, &mut |stage| screen.stage(&stage))?;
    screen.end();
    if CaseFile::write(&file, &provenance, case, &epoch)? {
        return Ok(Written::Now);
    }
    there()?;
    Ok(Written::Meanwhile)
}

/// The screen of a process that a run listens to.
pub struct Listened(());

impl Listened {
    /// From now on this process ends with the run: one that is killed leaves nothing behind that disturbs the next one.
    #[allow(clippy::new_without_default)]
    pub fn new() -> Self {
        process_group::end_with_parent();
        Self(())
    }
}

impl Screen for Listened {
    fn stage(&mut self, stage: &Stage) {
        if say(&Message::Stage(stage.clone())).and_then(|()| hear()).is_err() {
            // The run is gone, and would be disturbed by this process when it goes on.
            std::process::exit(1);
        }
    }

    fn is_watched(&self) -> bool {
        true
    }
}

/// Says why nothing was measured.
///
/// # Errors
/// If nobody listens.
pub fn report_failure(error: &anyhow::Error) -> io::Result<()> {
    let known = error.downcast_ref::<StudyError>();
    say(&Message::Failed {
        sentence: format!("{error:#}"),
        of_one_scene: known.is_none_or(StudyError::is_of_one_scene),
        wrong_answer: known.is_some_and(StudyError::is_wrong_answer),
    })
}

fn say(message: &Message) -> io::Result<()> {
    let line = serde_json::to_string(message).expect("a message has text keys");
    let mut out = io::stdout().lock();
    writeln!(out, "{MARK}{line}")?;
    out.flush()
}

/// The next line of the run.
fn hear() -> io::Result<String> {
    let mut line = String::new();
    match io::stdin().read_line(&mut line)? {
        0 => Err(io::ErrorKind::UnexpectedEof.into()),
        _ => Ok(line),
    }
}

/// Watches the builds of `case`, which a process measures by `args`: where one takes too long, the process starts itself
/// again without that structure, since a builder cannot be interrupted from within.
pub fn build_watch(case: &Case, args: Vec<OsString>) -> BuildWatch {
    let Some(limit) = case.settings.build_limit_s else { return BuildWatch::default() };
    let case = case.clone();
    let again = move |structure: usize| {
        let mut case = case.clone();
        let reason = format!("its build takes more than {limit} s: raise --build-limit, or set it to none");
        case.structures[structure].skipped = Some(reason);
        let text = serde_json::to_string(&case).expect("a case has text keys");
        let is_case = |arg: &OsString| arg.to_string_lossy().starts_with(&format!("--{CASE}="));
        let own =
            args.iter().skip(1).map(|arg| if is_case(arg) { format!("--{CASE}={text}").into() } else { arg.clone() });
        let mut command = Command::new(program::executable());
        command.args(own);
        replace(command);
    };
    BuildWatch::new(Duration::from_secs_f64(limit), Box::new(again))
}

/// Becomes the program that `command` starts.
#[cfg(unix)]
fn replace(mut command: Command) {
    use std::os::unix::process::CommandExt;
    let cause = command.exec();
    crate::output::tell_error(format_args!("this program cannot be started again: {cause}"));
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
        // The program of these tests knows no such option.
        let processes = Processes { options: vec!["--no-such-option".into()] };
        let out = tempfile::tempdir().unwrap();
        let case = example("Cube", 0, &["sah-kd"]);
        let error = processes.measure(&case, &out.path().join("a.json"), None, &mut |_| ()).unwrap_err();
        let sentence = error.to_string();
        assert!(sentence.contains("Cube epoch 0") && sentence.contains("without a reply"), "{sentence}");
        assert!(error.is_of_one_scene() && !error.is_wrong_answer());
    }
}
