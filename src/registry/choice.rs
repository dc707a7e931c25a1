use std::sync::Arc;

use serde_json::{Value, json};

use super::entry::{Entry, empty};
use crate::accel::{BuildError, Capabilities, DynAccel, Observed};
use crate::geometry::Mesh;
use crate::names::suggestion;
use crate::runner::{Program, Runner};
use crate::validate::conformance::Subject;

/// A structure with its configuration and the name to print.
#[derive(Clone)]
pub struct Choice {
    pub entry: Entry,
    /// The whole configuration, including defaults.
    pub config: Value,
    /// `name`, or `name:key=value,..` with the values that differ from the default. The label of an external program is
    /// the program name, followed by ` (own clock)`.
    pub label: String,
}

#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum ChoiceError {
    #[error("there is no structure {name:?}{suggestion}; the structures are: {known}")]
    Unknown { name: String, suggestion: String, known: String },
    #[error("{name} does not support the triangle test {test:?}{suggestion}; its tests are: {known}")]
    Test { name: String, test: String, suggestion: String, known: String },
    #[error("{name} has no option {key:?}{suggestion}; its options are: {known}")]
    Key { name: String, key: String, suggestion: String, known: String },
    #[error("{part:?} in {spec:?} is not of the form key=value")]
    Form { spec: String, part: String },
    #[error("{name} does not accept {given} ({reason}){suggestion}; allowed: {values}")]
    Value { name: String, given: String, reason: String, suggestion: String, values: String },
    #[error("{name} no longer accepts {given}: use {instead}")]
    Removed { name: String, given: String, instead: &'static str },
    #[error("{name} rejects this configuration: {reason}")]
    Config { name: String, reason: String },
}

/// Each element has a key, a value that the key no longer accepts, and the replacement.
const REMOVED: [(&str, &str, &str); 1] =
    [("batch", "interleaved", "batch=packets, which interleaves the rays outside packets")];

/// The entry name of all runners (external programs).
pub const RUNNER: &str = "runner";

/// The label suffix of programs that measure their own times.
const OWN_CLOCK: &str = " (own clock)";

pub fn plain_name(label: &str) -> &str {
    label.strip_suffix(OWN_CLOCK).unwrap_or(label)
}

pub fn is_named(label: &str, name: &str) -> bool {
    plain_name(label).eq_ignore_ascii_case(plain_name(name))
}

impl Choice {
    /// `overrides` are pairs of key and value. `name_test` adds the triangle test to the label. Callers set `name_test`
    /// if `entry` is not the first entry with its name.
    pub(super) fn of(entry: &Entry, overrides: &[(&str, &str)], name_test: bool) -> Result<Self, ChoiceError> {
        let mut config = entry.config.clone();
        let keys = config.as_object_mut().expect("checked when it was registered");
        let mut shown: Vec<String> = vec![];
        shown.extend(name_test.then(|| format!("test={}", entry.triangle_test)));
        for &(key, text) in overrides {
            let name = entry.name.clone();
            if !keys.contains_key(key) {
                let known: Vec<&str> = ["test"].into_iter().chain(keys.keys().map(String::as_str)).collect();
                let suggestion = suggestion(key, known.iter().copied());
                return Err(ChoiceError::Key { name, key: key.into(), suggestion, known: known.join(", ") });
            }
            let value = serde_json::from_str(text).unwrap_or_else(|_| Value::String(text.into()));
            entry.takes(key, &value).map_err(|reason| {
                let given = format!("{key}={text}");
                if let Some(&(.., instead)) = REMOVED.iter().find(|removed| (removed.0, removed.1) == (key, text)) {
                    return ChoiceError::Removed { name, given, instead };
                }
                let values = entry.values(key);
                let reason = reason.split(", expected").next().unwrap_or_default().into();
                ChoiceError::Value { name, given, reason, suggestion: suggestion(text, values.split(", ")), values }
            })?;
            if keys[key] != value {
                shown.push(format!("{key}={text}"));
            }
            keys.insert(key.into(), value);
        }
        let label = if shown.is_empty() { entry.name.clone() } else { format!("{}:{}", entry.name, shown.join(",")) };
        let choice = Self { entry: entry.clone(), config, label };
        match choice.build(&Arc::new(empty())) {
            Err(BuildError::Config(reason)) => Err(ChoiceError::Config { name: entry.name.clone(), reason }),
            // This build over the empty mesh only checks the configuration. Only `BuildError::Config` is reported.
            _ => Ok(choice),
        }
    }

    pub fn build(&self, mesh: &Arc<Mesh>) -> Result<Box<dyn DynAccel>, BuildError> {
        (self.entry.build)(mesh, &self.config)
    }

    pub fn subject(&self) -> Subject {
        let own = self.clone();
        Subject::new(&self.label, self.triangle_test(), move |mesh| own.build(mesh))
    }

    pub fn triangle_test(&self) -> &'static str {
        self.entry.triangle_test
    }

    pub fn of_program(program: Program) -> Self {
        let label = program.name() + OWN_CLOCK;
        let config = json!({ "command": program.command(), "build": program.build_id(), "clock": "own" });
        let build = move |mesh: &Arc<_>, _: &_| {
            Runner::build(&program, mesh).map(|runner| Box::new(runner) as Box<dyn DynAccel>)
        };
        let entry = Entry {
            name: RUNNER.into(),
            triangle_test: "own",
            observed: Observed::NONE,
            conventions: &[],
            capabilities: Capabilities::ALL,
            is_builtin: false,
            config: config.clone(),
            read: |_| Ok(()),
            build: Arc::new(build),
        };
        Self { entry, config, label }
    }

    pub fn command(&self) -> Option<&str> {
        (self.entry.name == RUNNER).then(|| self.config["command"].as_str())?
    }
}
