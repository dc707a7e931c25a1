//! Programs of other languages as structures.

use std::sync::Arc;

use serde_json::json;

use super::{Choice, Entry};
use crate::accel::{Capabilities, DynAccel, Observed};
use crate::runner::{Program, Runner};

/// The name of all runners; each has its command as configuration.
pub const RUNNER: &str = "runner";

impl Choice {
    /// The label of a program of this name.
    pub fn own_clock(name: &str) -> String {
        format!("{name} (own clock)")
    }

    /// The structure that `program` implements. Its label says whose clock times it.
    pub fn of_program(program: Program) -> Self {
        let label = Self::own_clock(&program.name());
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
}
