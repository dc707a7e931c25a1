//! Runners (external programs that implement a structure) on the command line and in cases.

use std::time::Duration;

use serde::{Deserialize, Serialize};

use super::Seconds;
use crate::registry::{Choice, Registry, is_named, plain_name};
use crate::runner::Program;

/// Default timeout of a reply of a runner.
pub const RUNNER_LIMIT: Seconds = Seconds::whole(120);

/// A runner in a case.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct RunnerRequest {
    pub command: String,
    /// Timeout of a reply, seconds.
    pub limit_s: f64,
    /// The configuration. It includes a digest of the program: a changed program counts as another structure.
    pub config: serde_json::Value,
}

/// The structure of the runner `[NAME=]COMMAND` with the timeout `limit_s`. An error if it violates the protocol.
pub fn runner(command: &str, limit_s: f64) -> anyhow::Result<Choice> {
    let program = Program::new(command, Duration::from_secs_f64(limit_s));
    let program = program.map_err(|problem| anyhow::anyhow!("--runner {command:?}: {problem}"))?;
    Ok(Choice::of_program(program))
}

/// The structures of several runners; a repeated command counts once. An error if two runners share a name, or a
/// runner has the name of a structure.
pub fn runners(registry: &Registry, commands: &[String], limit_s: f64) -> anyhow::Result<Vec<Choice>> {
    let mut chosen: Vec<Choice> = vec![];
    for command in commands {
        if chosen.iter().any(|other| other.command() == Some(command)) {
            continue;
        }
        let runner = runner(command, limit_s)?;
        let name = plain_name(&runner.label);
        let (is_shared, other) = if registry.names().iter().any(|other| is_named(&runner.label, other)) {
            (true, "another structure")
        } else {
            (chosen.iter().any(|other| is_named(&other.label, name)), "another runner")
        };
        anyhow::ensure!(
            !is_shared,
            "--runner {command:?} and {other} share the name {name}: rename the runner with NAME=COMMAND"
        );
        chosen.push(runner);
    }
    Ok(chosen)
}
