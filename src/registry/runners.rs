//! Runners as structures.

use std::sync::Arc;

use serde_json::json;

use super::{Choice, Entry};
use crate::accel::{Capabilities, DynAccel, Observed};
use crate::runner::{Program, Runner};

/// The name of all runners; each has its command as configuration.
pub const RUNNER: &str = "runner";

const OWN_CLOCK: &str = " (own clock)";

/// The name of a structure; for a runner, without the words about its clock.
pub fn plain_name(label: &str) -> &str {
    label.strip_suffix(OWN_CLOCK).unwrap_or(label)
}

/// Whether `name`, as a user types it, names the structure of this label; a runner's label also has words about its
/// clock.
pub fn is_named(label: &str, name: &str) -> bool {
    plain_name(label).eq_ignore_ascii_case(plain_name(name))
}

impl Choice {
    /// The structure that `program` implements. Its label names the clock of its times.
    pub fn of_program(program: Program) -> Self {
        let label = program.name() + OWN_CLOCK;
        let config = json!({ "command": program.command(), "build": program.build_id(), "clock": "own" });
        let build = move |mesh: &Arc<_>, _: &_| {
            Runner::build(&program, mesh).map(|runner| Box::new(runner) as Box<dyn DynAccel>)
        };
        let entry = Entry {
            is_builtin: false,
            name: RUNNER.into(),
            triangle_test: "own",
            observed: Observed::NONE,
            conventions: &[],
            capabilities: Capabilities::ALL,
            config: config.clone(),
            read: |_| Ok(()),
            build: Arc::new(build),
        };
        Self { entry, config, label }
    }

    /// The command line of a program.
    pub fn command(&self) -> Option<&str> {
        (self.entry.name == RUNNER).then(|| self.config["command"].as_str())?
    }
}
