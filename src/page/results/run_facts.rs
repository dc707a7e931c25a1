//! The origin of all numbers in the results.

use serde::{Deserialize, Serialize};

use crate::measure::Provenance;
use crate::page::runs::Runs;
use crate::report::words::each_once;

/// The one build and machine of a run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct RunFacts {
    pub version: String,
    pub commit: String,
    pub cpu: String,
    pub simd: String,
    /// The largest number of threads of any study.
    pub threads: usize,
    pub rustc: String,
    pub target: String,
    pub obvhs: String,
    /// Days of the first and of the last measurement, in UTC.
    pub days: [String; 2],
    pub commands: Vec<String>,
}

impl RunFacts {
    /// Rejects runs of more than one commit or machine.
    pub fn new(runs: &Runs) -> anyhow::Result<Self> {
        let all = runs.provenances();
        let one = |what: &'static str, of: fn(&Provenance) -> &String| -> anyhow::Result<String> {
            let mut values: Vec<&str> = all.iter().map(|p| of(p).as_str()).collect();
            values.sort_unstable();
            values.dedup();
            match values[..] {
                [] => Ok("unknown".into()),
                [only] => Ok(only.into()),
                _ => anyhow::bail!(
                    "these runs have more than one {what} ({}), but --results needs a single run: measure everything \
                     again into a new folder",
                    values.join(", ")
                ),
            }
        };
        let days = || all.iter().map(|p| p.date.split('T').next().unwrap_or("").to_owned());
        Ok(Self {
            version: one("version", |p| &p.version)?,
            commit: one("commit", |p| &p.commit)?,
            cpu: one("machine", |p| &p.cpu)?,
            simd: one("instruction set", |p| &p.simd)?,
            threads: all.iter().map(|p| p.threads).max().unwrap_or(1),
            rustc: one("compiler", |p| &p.rustc)?,
            target: one("target", |p| &p.target)?,
            obvhs: one("version of obvhs", |p| &p.obvhs)?,
            days: [days().min().unwrap_or_default(), days().max().unwrap_or_default()],
            commands: each_once(runs.commands().iter().map(|command| portable(command))),
        })
    }

    /// Commit, machine and day in one sentence.
    pub fn sentence(&self) -> String {
        let [first, last] = &self.days;
        let days = if first == last { first.clone() } else { format!("{first} to {last}") };
        let threads = if self.threads > 1 { "one thread where no other number is named" } else { "one thread" };
        let Self { version, commit, cpu, simd, .. } = self;
        format!(
            "All numbers come from one run of sahara {version}, commit {commit}, on {threads} ({cpu}, {simd}), {days}."
        )
    }
}

/// A command without the folders of its machine and the file name of its program.
fn portable(command: &str) -> String {
    let name = |(i, word): (usize, &str)| match word.rsplit('/').next() {
        _ if i == 0 => "sahara".to_owned(),
        Some(last) if word.starts_with('/') => last.to_owned(),
        _ => word.to_owned(),
    };
    command.split(' ').enumerate().map(name).collect::<Vec<_>>().join(" ")
}
