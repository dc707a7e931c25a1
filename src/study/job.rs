//! A case as a job: the command line of a run, and which of its cases a process measures.

use std::ffi::OsString;
use std::path::Path;
use std::str::FromStr;

use serde::{Deserialize, Serialize};

use super::journal::{self, CaseFile, Header, Read};
use super::{AnyStudy, Chosen, Plan, Planned, Screen, StudyError};
use crate::escaped::quoted;
use crate::measure::{Provenance, SystemClock};
use crate::registry::Registry;

/// Which case a process measures.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Job {
    pub study: String,
    /// Name of the scene: of those named on the command line no other is loaded.
    pub scene: String,
    pub key: String,
    /// The cores that the threads of the run are bound to.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub cores: Option<Vec<usize>>,
}

impl Job {
    /// Of a case of `study`, on whatever cores.
    pub fn of(study: &str, case: &Planned) -> Self {
        Self { study: study.into(), scene: case.loads.clone(), key: case.key.clone(), cores: None }
    }

    /// The case of a plan that this is.
    ///
    /// # Errors
    /// If there is none.
    pub fn find<'a, C>(&self, plan: &'a Plan<C>) -> Result<&'a Planned, StudyError> {
        let cause =
            || "its scene is not what it was when it was planned: plan it anew (Snakemake: remove plan.txt)".to_owned();
        let found = plan.cases.iter().find(|case| case.key == self.key);
        found.ok_or_else(|| StudyError::Job { key: self.key.clone(), cause: cause() })
    }
}

impl FromStr for Job {
    type Err = serde_json::Error;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        serde_json::from_str(text)
    }
}

/// The option that gives a process its job, and the one that has it write a file.
pub const OPTION: &str = "case";
pub const OUT: &str = "out";

/// What became of a job that writes a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Done {
    Measured,
    /// It had been measured before.
    Before,
    /// Another one has measured it meanwhile.
    Meanwhile,
}

impl dyn AnyStudy + '_ {
    /// What a process with a job and a file does: measures the case and writes it, unless it is there.
    ///
    /// # Errors
    /// As [`Study::plan`](super::Study::plan), and if the file cannot be written or holds anything else, there are
    /// fewer cores than threads, or nothing can be measured: then it is as it was.
    pub fn write_job(
        &self,
        chosen: Chosen,
        registry: &Registry,
        job: &Job,
        out: &Path,
        screen: &mut dyn Screen,
    ) -> anyhow::Result<Done> {
        let read = self.reader();
        // As the run that would have started a process for it.
        let command = command_of_run(std::env::args_os());
        if is_repeated(job, out, &command, read) {
            return Ok(Done::Before);
        }
        let plan = self.plan(&*self.args(chosen)?, registry)?;
        let case = job.find(&plan)?;
        let provenance = Provenance { process_per_epoch: true, command, ..Provenance::of(&plan.threads) };
        let header = Header::new(&job.study, &plan.settings, provenance);
        let there = || CaseFile::there(out, &header, &case.key, read);
        if there()?.is_some() {
            return Ok(Done::Before);
        }
        // A run warns of it. Nobody reads the logs of all jobs, and a file that is there is not measured again.
        if let Some(cause) = header.provenance.too_many_threads() {
            return Err(StudyError::Job { key: case.key.clone(), cause }.into());
        }
        let file = journal::place(out)?;
        screen.begin(case.work);
        screen.case(&format!("{}, {}", job.study, case.title), case.work);
        let measured = (plan.measure)(case, &SystemClock::start(), &mut |stage| screen.stage(&stage))?;
        screen.end();
        if journal::write(&file, &journal::text(&header, &case.key, &measured, read))? {
            return Ok(Done::Measured);
        }
        there()?;
        Ok(Done::Meanwhile)
    }
}

/// Whether this program has done the job before, by the same command on such a machine: that is known without the scene.
fn is_repeated<C>(job: &Job, out: &Path, command: &str, read: Read<C>) -> bool {
    let Ok(there) = CaseFile::read(out) else { return false };
    let (own, other) = (Provenance::capture(1), &there.header.provenance);
    let is_known = [&own.build, &own.cpu].iter().all(|part| *part != "unknown");
    let is_same =
        (&own.build, &own.simd, &own.cpu) == (&other.build, &other.simd, &other.cpu) && command == other.command;
    let is_of_job = (&job.study, &job.key) == (&there.header.study, &there.key);
    // Programs and files of rays may have changed since.
    let settings = &there.header.settings;
    let is_replayed =
        settings.get("workloads").and_then(|text| text.as_str()).is_some_and(|text| text.starts_with("replayed"));
    let reads_files = settings.contains_key("runners") || is_replayed;
    is_known && !reads_files && is_same && is_of_job && there.read_case(read).is_ok()
}

/// The command line without the job: the same for all jobs of a run.
fn command_of_run(args: impl Iterator<Item = OsString>) -> String {
    let [case, out] = [OPTION, OUT].map(|option| format!("--{option}"));
    let mut words = vec![];
    let mut skips = false;
    for arg in args {
        let is_value = std::mem::replace(&mut skips, arg == *case || arg == *out);
        let option = arg.as_encoded_bytes().split(|&byte| byte == b'=').next();
        if !is_value && option != Some(case.as_bytes()) && option != Some(out.as_bytes()) {
            words.push(quoted(&arg));
        }
    }
    words.join(" ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_jobs_of_a_run_have_its_command() {
        let words = ["sahara", "study", "costs", "my mesh.ply", "--case={\"key\":\"a\"}", "--out", "runs/costs/a.json"];
        assert_eq!(command_of_run(words.map(OsString::from).into_iter()), "sahara study costs 'my mesh.ply'");
        let words = ["sahara", "--case", "{}", "compare", "--out=a.json", "--outer"];
        assert_eq!(command_of_run(words.map(OsString::from).into_iter()), "sahara compare --outer");
    }
}
