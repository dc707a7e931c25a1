//! The registry of structures and scene generators, by name.

mod builtin;
mod choice;
mod entry;
mod keys;

use std::sync::Arc;

use serde_json::{Map, Value};

use crate::accel::{Accel, BuildError};
use crate::geometry::Mesh;
use crate::names::suggestion;
use crate::offered::Offered;
use crate::panics::caught;
use crate::scene::Scene;
use entry::{Build, BuildResult};

pub use choice::{Choice, ChoiceError, RUNNER, is_named, plain_name};
pub use entry::Entry;
pub use keys::Key;

/// The registered structures, in the order of tables, and the scene generators.
#[derive(Clone)]
pub struct Registry {
    entries: Vec<Entry>,
    generators: Vec<(&'static str, Generate)>,
}

/// Generates a scene from the text after the colon, such as `7` in `icosphere:7`.
pub type Generate = fn(&str) -> anyhow::Result<Scene>;

impl Registry {
    pub fn empty() -> Self {
        Self { entries: vec![], generators: vec![] }
    }

    /// Adds a scene generator. On the command line, `name:parameters` selects a generated scene.
    ///
    /// # Panics
    /// If `name` is empty or already taken. If `name` contains anything except lower-case letters, digits and hyphens.
    pub fn with_generator(mut self, name: &'static str, generate: Generate) -> Self {
        let plain = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '-';
        assert!(!name.is_empty() && name.chars().all(plain), "the name {name:?}");
        assert!(!self.has_generator(name), "there is already a generator {name:?}");
        self.generators.push((name, generate));
        self
    }

    pub fn has_generator(&self, name: &str) -> bool {
        self.generator(name).is_some()
    }

    pub fn generated(&self, name: &str, parameters: &str) -> Option<anyhow::Result<Scene>> {
        Some(self.generator(name)?(parameters))
    }

    fn generator(&self, name: &str) -> Option<Generate> {
        self.generators.iter().find(|(own, _)| own.eq_ignore_ascii_case(name)).map(|&(_, generate)| generate)
    }

    /// Adds a structure under `name`, with the default configuration `config`.
    ///
    /// # Panics
    /// If `name` is empty or `all`. If `name` contains `:`, `,`, `=`, a space, a tab or a newline. If `name` already
    /// has an entry with the triangle test of `A`. If `config` does not serialise to a JSON object or to null.
    pub fn with<A: Accel>(self, name: &str, config: A::Config) -> Self {
        self.entered::<A>(name, config, |mesh, config| Ok(Box::new(A::build(mesh, config)?)))
    }

    /// Adds a structure that is compiled in `sahara-core`.
    fn offering<A: Offered>(self, name: &str, config: A::Config) -> Self {
        self.entered::<A>(name, config, A::boxed)
    }

    fn entered<A: Accel>(
        mut self,
        name: &str,
        config: A::Config,
        build: fn(&Arc<Mesh>, &A::Config) -> BuildResult,
    ) -> Self {
        assert!(
            !name.is_empty() && name != "all" && !name.contains([':', ',', '=', ' ', '\t', '\n']),
            "the name {name:?} must not be empty or \"all\", and must not contain ':', ',', '=' or white space"
        );
        let test = A::TRIANGLE_TEST;
        assert!(self.find(name, test).is_none(), "there is already a structure {name:?} with the test {test:?}");
        let config = match serde_json::to_value(config).expect("a configuration serialises") {
            Value::Null => Value::Object(Map::new()),
            value @ Value::Object(_) => value,
            other => panic!("the configuration of {name:?} must be a struct with named fields, not {other}"),
        };
        let build: Build = Arc::new(move |mesh, config| {
            let config = parse::<A>(config).map_err(BuildError::Config)?;
            // A builder of another crate may panic on an unexpected mesh. The panic must not end the run.
            caught(|| build(mesh, &config)).unwrap_or(Err(BuildError::Panic))
        });
        self.entries.push(Entry {
            name: name.into(),
            triangle_test: test,
            observed: A::OBSERVED,
            conventions: A::CONVENTIONS,
            capabilities: A::CAPABILITIES,
            is_builtin: false,
            config,
            read: |config| parse::<A>(config).map(drop),
            build,
        });
        self
    }

    pub fn entries(&self) -> &[Entry] {
        &self.entries
    }

    pub fn find(&self, name: &str, test: &str) -> Option<&Entry> {
        self.entries.iter().find(|e| e.name == name && e.triangle_test == test)
    }

    /// Reads `NAME` or `NAME:key=value,..`. The key `test` chooses the triangle test. Without this key, the first entry
    /// with the name `NAME` is chosen.
    ///
    /// # Errors
    /// If the name, a key, a value or the triangle test is not accepted.
    pub fn choose(&self, spec: &str) -> Result<Choice, ChoiceError> {
        let (name, pairs) = spec.split_once(':').unwrap_or((spec, ""));
        let mut overrides = vec![];
        for part in pairs.split(',').filter(|part| !part.is_empty()) {
            let form = || ChoiceError::Form { spec: spec.into(), part: part.into() };
            overrides.push(part.split_once('=').ok_or_else(form)?);
        }
        let test = overrides.iter().position(|(key, _)| *key == "test").map(|i| overrides.remove(i).1);

        let named: Vec<&Entry> = self.entries.iter().filter(|e| e.name.eq_ignore_ascii_case(name)).collect();
        let Some(&first) = named.first() else {
            let known = self.names();
            let suggestion = suggestion(name, known.iter().copied());
            return Err(ChoiceError::Unknown { name: name.into(), suggestion, known: known.join(", ") });
        };
        let Some(test) = test else { return Choice::of(first, &overrides, false) };
        let Some(entry) = named.iter().find(|e| e.triangle_test.eq_ignore_ascii_case(test)) else {
            let known: Vec<&str> = named.iter().map(|e| e.triangle_test).collect();
            let suggestion = suggestion(test, known.iter().copied());
            let name = first.name.clone();
            return Err(ChoiceError::Test { name, test: test.into(), suggestion, known: known.join(", ") });
        };
        Choice::of(entry, &overrides, !std::ptr::eq(*entry, first))
    }

    pub fn all(&self) -> Vec<Choice> {
        let default = |e| Choice::of(e, &[], !self.is_first(e)).expect("a default configuration is accepted");
        self.entries.iter().map(default).collect()
    }

    pub fn names(&self) -> Vec<&str> {
        self.entries.iter().filter(|e| self.is_first(e)).map(|e| e.name.as_str()).collect()
    }

    /// Whether `entry` is the first entry with its name.
    fn is_first(&self, entry: &Entry) -> bool {
        self.entries.iter().find(|e| e.name == entry.name).is_some_and(|e| std::ptr::eq(e, entry))
    }
}

/// The registry stores a null configuration as an empty map.
fn parse<A: Accel>(config: &Value) -> Result<A::Config, String> {
    serde_json::from_value(config.clone()).or_else(|error| match config {
        Value::Object(map) if map.is_empty() => serde_json::from_value(Value::Null).map_err(|_| error.to_string()),
        _ => Err(error.to_string()),
    })
}

#[cfg(test)]
mod tests {
    use super::entry::empty;
    use super::*;
    use crate::study::measure::tests::{Flaw, Flawed, FlawedConfig};

    #[test]
    fn structures_that_reject_the_empty_mesh_can_be_chosen() {
        let config = FlawedConfig { flaw: Flaw::Rootless };
        let registry = Registry::builtin().with::<Flawed>("a", config);
        assert_eq!(registry.all().len(), registry.entries().len());
        let choice = registry.choose("a").unwrap();
        assert!(choice.build(&Arc::new(empty())).is_err() && choice.entry.absence().is_none());
    }

    #[test]
    fn a_removed_value_names_its_replacement() {
        let error = Registry::builtin().choose("sah-bvh:batch=interleaved").map(|choice| choice.label).unwrap_err();
        let sentence = "sah-bvh no longer accepts batch=interleaved: use batch=packets, which interleaves the rays \
                        outside packets";
        assert_eq!(error.to_string(), sentence);
    }
}
