//! Runners are external programs that implement a structure.

use std::time::Duration;

use serde::{Deserialize, Serialize};

use super::Seconds;
use crate::registry::{Choice, Registry, is_named, plain_name};
use crate::runner::Program;

/// Default timeout for a runner's reply.
pub const RUNNER_LIMIT: Seconds = Seconds::whole(120);

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct RunnerRequest {
    pub command: String,
    /// Timeout for a reply, in seconds.
    pub limit_s: f64,
    /// Contains a digest of the program: a changed program counts as another structure.
    pub config: serde_json::Value,
}

/// `command` has the form `[NAME=]COMMAND`.
pub fn runner(command: &str, limit_s: f64) -> anyhow::Result<Choice> {
    let program = Program::new(command, Duration::from_secs_f64(limit_s));
    let program = program.map_err(|problem| anyhow::anyhow!("--runner {command:?}: {problem}"))?;
    Ok(Choice::of_program(program))
}

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
