//! A case in a process of its own.
//!
//! Where the system puts a program, its stack and its heap can change the speed of a structure by some percent, for as long as
//! the process lives: only samples from several processes say by how much (Mytkowicz et al., Producing Wrong Data Without
//! Doing Anything Obviously Wrong!, 2009; Kalibera and Jones, Rigorous Benchmarking in Reasonable Time, 2013).
//!
//! The process is this program with the same command line and a [`Job`]. On its standard output it says, a marked line of JSON each,
//! what it does, and at last what it has measured. After each line it waits for one in answer: so the run that listens does nothing
//! while it times. Other lines are a structure's own, and go to standard error.
//!
//! A job on another machine is the same command line with a file beside: it writes the case, and nobody answers it.

use std::ffi::OsString;
use std::io::{self, BufRead, BufReader, Write};
use std::process::{Child, Command, Stdio};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError, Weak};
use std::thread;
use std::time::Duration;

use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::job::{Job, OPTION};
use super::journal::Read;
use super::{AnyStudy, Chosen, Plan, Stage, StudyError};
use crate::measure::{SystemClock, process_group, program};
use crate::registry::Registry;

/// A line of a process.
#[derive(Serialize, Deserialize)]
enum Said {
    Build(String),
    Rays(String),
    Check(String),
    Trace(usize, usize),
    Count,
    Measured(Value),
    Failed { sentence: String, of_one_scene: bool, wrong_answer: bool },
}

impl From<&Stage<'_>> for Said {
    fn from(stage: &Stage) -> Self {
        match *stage {
            Stage::Build(what) => Self::Build(what.into()),
            Stage::Rays(what) => Self::Rays(what.into()),
            Stage::Check(what) => Self::Check(what.into()),
            Stage::Trace(taken, total) => Self::Trace(taken, total),
            Stage::Count => Self::Count,
        }
    }
}

/// How processes are started.
pub struct Processes {
    /// The command line of this one, without its name.
    args: Vec<OsString>,
}

/// What the lines of a process begin with.
const MARK: &str = "\u{1e}case ";

impl Processes {
    /// Of this program, which was started with `args`, its name first.
    pub fn new(args: impl IntoIterator<Item = OsString>) -> Self {
        Self { args: args.into_iter().skip(1).collect() }
    }

    /// Has a process measure a case.
    ///
    /// # Errors
    /// As the measuring of the case, and if the process cannot be started or ends without an answer.
    pub fn measure<C>(&self, job: &Job, read: Read<C>, progress: &mut dyn FnMut(Stage)) -> Result<C, StudyError> {
        let value = self.value(job, progress)?;
        let cause = |cause| format!("it said {:?}: {cause}", value.to_string());
        read(&value).map_err(|error| StudyError::Process { key: job.key.clone(), cause: cause(error) })
    }

    /// Likewise, as the process says it.
    fn value(&self, job: &Job, progress: &mut dyn FnMut(Stage)) -> Result<Value, StudyError> {
        let trouble = |cause: String| StudyError::Process { key: job.key.clone(), cause };
        let job_text = serde_json::to_string(job).expect("a job has text keys");
        let mut command = Command::new(program::executable());
        command.arg(format!("--{OPTION}={job_text}")).args(&self.args);
        process_group::set_apart(&mut command);
        // Programs that are timed have files there: what is left when the process is ended goes with the folder.
        let has_programs = self.args.iter().any(|arg| arg.to_string_lossy().starts_with("--runner"));
        let scratch = if has_programs { tempfile::Builder::new().prefix("sahara-").tempdir().ok() } else { None };
        command.envs(scratch.iter().flat_map(|folder| ["TMPDIR", "TMP", "TEMP"].map(|name| (name, folder.path()))));
        let child = command.stdin(Stdio::piped()).stdout(Stdio::piped()).spawn();
        let mut child = child.map_err(|cause| trouble(format!("it cannot be started: {cause}")))?;
        let (told, said) = (child.stdin.take(), child.stdout.take());
        let child = Guard::new(child);
        let mut told = told.expect("it has an input");
        // A process that has ended already is told by what it has said, or how it ended.
        let mut tell = |line: &str| {
            let _ = writeln!(told, "{line}");
        };
        for line in BufReader::new(said.expect("it has an output")).split(b'\n') {
            let line = line.map_err(|cause| trouble(cause.to_string()))?;
            let line = String::from_utf8_lossy(&line);
            let Some((own, said)) = line.split_once(MARK) else {
                crate::output::tell(&line);
                continue;
            };
            let _ = write!(io::stderr(), "{own}");
            match serde_json::from_str(said).map_err(|cause| trouble(format!("it said {said:?}: {cause}")))? {
                Said::Build(what) => progress(Stage::Build(&what)),
                Said::Rays(what) => progress(Stage::Rays(&what)),
                Said::Check(what) => progress(Stage::Check(&what)),
                Said::Trace(taken, total) => progress(Stage::Trace(taken, total)),
                Said::Count => progress(Stage::Count),
                Said::Measured(case) => return Ok(case),
                Said::Failed { sentence, of_one_scene, wrong_answer } => {
                    return Err(StudyError::Told { sentence, of_one_scene, wrong_answer });
                }
            }
            tell("");
        }
        // Others may end it meanwhile.
        let status = loop {
            if let Some(status) = locked(&child.0).try_wait().map_err(|cause| trouble(cause.to_string()))? {
                break status;
            }
            thread::sleep(Duration::from_millis(1));
        };
        Err(trouble(format!("it ended without an answer ({status})")))
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

impl dyn AnyStudy + '_ {
    /// What a process with a job does: measures that one case, and says so on standard output.
    ///
    /// # Errors
    /// If that is closed.
    pub fn answer_job(&self, chosen: Chosen, registry: &Registry, job: &Job) -> anyhow::Result<()> {
        Ok(answer(|| self.plan(&*self.args(chosen)?, registry), job)?)
    }
}

/// What a process with a job does: measures the case of the plan that `plan` makes, and says so.
///
/// # Errors
/// If nobody listens; all else is said.
pub fn answer<C: Serialize>(plan: impl FnOnce() -> anyhow::Result<Plan<C>>, job: &Job) -> io::Result<()> {
    end_with_parent();
    let said = match plan() {
        Ok(plan) => match job.find(&plan) {
            Ok(case) => {
                let mut progress = |stage: Stage| {
                    if say(&Said::from(&stage)).and_then(|()| hear()).is_err() {
                        // The run is gone, and would be disturbed by this process when it goes on.
                        std::process::exit(1);
                    }
                };
                match (plan.measure)(case, &SystemClock::start(), &mut progress) {
                    Ok(case) => Said::Measured(serde_json::to_value(case).expect("a case has text keys")),
                    Err(error) => failed(&error),
                }
            }
            Err(error) => failed(&error),
        },
        Err(error) => Said::Failed { sentence: format!("{error:#}"), of_one_scene: true, wrong_answer: false },
    };
    say(&said)
}

fn failed(error: &StudyError) -> Said {
    Said::Failed {
        sentence: error.to_string(),
        of_one_scene: error.is_of_one_scene(),
        wrong_answer: error.is_wrong_answer(),
    }
}

fn say(said: &Said) -> io::Result<()> {
    let line = serde_json::to_string(said).expect("what is said has text keys");
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

/// A run that is killed leaves nothing behind that disturbs the next one.
fn end_with_parent() {
    #[cfg(target_os = "linux")]
    let _ = nix::sys::prctl::set_pdeathsig(nix::sys::signal::Signal::SIGKILL);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::epoch::Epoch;

    #[test]
    fn a_process_that_ends_without_an_answer_is_one_sentence() {
        // The program of these tests knows no such option.
        let processes = Processes::new(["tests".into(), "--no-such-option".into()]);
        let job = Job { study: "compare".into(), scene: "Cube".into(), key: "Cube 0123 epoch 0".into(), cores: None };
        let error = processes.measure(&job, |value| Epoch::deserialize(value), &mut |_| ()).unwrap_err();
        let sentence = error.to_string();
        assert!(sentence.contains("Cube 0123 epoch 0") && sentence.contains("without an answer"), "{sentence}");
        assert!(error.is_of_one_scene() && !error.is_wrong_answer());
    }
}
