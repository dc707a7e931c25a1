//! The structures by name: the only place that names them all.

mod keys;
mod peers;
mod runners;

use std::panic::{self, AssertUnwindSafe};
use std::sync::Arc;

use serde_json::{Map, Value};

pub use keys::Key;
pub use runners::RUNNER;

use crate::accel::{Accel, BuildError, Capabilities, DynAccel, Observed};
use crate::brute_force::{BruteForce, BruteForceConfig};
use crate::bvh8::{Bvh8, Bvh8Config, Partition};
use crate::external::obvhs::{Native, ObvhsBvh2, ObvhsConfig, ObvhsCwBvh, Over, RtTest};
use crate::geometry::Mesh;
use crate::kdtree::{KdConfig, KdTree};
use crate::names::suggestion;
use crate::offered::Offered;
use crate::triangle::{BaldwinWeber, EdgeF64, Exact, MollerTrumbore, MollerTrumboreF64, Plucker, Watertight};
use crate::validate::Judged;
use crate::validate::conformance::Subject;

/// The structures that a run can choose from, in the order of tables.
#[derive(Clone)]
pub struct Registry {
    entries: Vec<Entry>,
}

/// One structure over one triangle test, with its default configuration.
#[derive(Clone)]
pub struct Entry {
    /// As written on the command line; entries of one structure over several tests share it.
    pub name: String,
    /// [`Accel::TRIANGLE_TEST`].
    pub triangle_test: &'static str,
    /// [`Accel::OBSERVED`].
    pub observed: Observed,
    /// [`Accel::CONVENTIONS`].
    pub conventions: &'static [&'static str],
    /// [`Accel::CAPABILITIES`].
    pub capabilities: Capabilities,
    config: Value,
    /// Whether a configuration can be read, before it is known whether its values go together.
    read: fn(&Value) -> Result<(), String>,
    build: Build,
}

type Built = Result<Box<dyn DynAccel>, BuildError>;
type Build = Arc<dyn Fn(&Arc<Mesh>, &Value) -> Built + Send + Sync>;

/// A structure that a run has chosen: what is built, and the name to print.
#[derive(Clone)]
pub struct Choice {
    pub entry: Entry,
    /// The whole configuration, defaults included.
    pub config: Value,
    /// `name`, or `name:key=value,..` with the values that differ from the default.
    pub label: String,
}

/// Why a choice of structure is refused.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum ChoiceError {
    #[error("there is no structure {name:?}{suggestion}; there are: {known}")]
    Unknown { name: String, suggestion: String, known: String },
    #[error("{name} is not offered over the triangle test {test:?}{suggestion}; it is over: {known}")]
    Test { name: String, test: String, suggestion: String, known: String },
    #[error("{name} has no key {key:?}{suggestion}; its keys are: {known}")]
    Key { name: String, key: String, suggestion: String, known: String },
    #[error("{part:?} in {spec:?} is not of the form key=value")]
    Form { spec: String, part: String },
    #[error("{name} does not take {given} ({reason}){suggestion}; allowed: {values}")]
    Value { name: String, given: String, reason: String, suggestion: String, values: String },
    #[error("{name} cannot be configured so: {reason}")]
    Config { name: String, reason: String },
}

impl Registry {
    /// No structure at all.
    pub fn empty() -> Self {
        Self { entries: vec![] }
    }

    /// The structures of this crate.
    pub fn builtin() -> Self {
        // The default comes first: the one that is right on every ray.
        let ours = Self::empty()
            .over::<Exact>()
            .over::<MollerTrumbore>()
            .over::<Watertight>()
            .over::<BaldwinWeber>()
            .over::<Plucker>()
            .over::<MollerTrumboreF64>()
            .over::<EdgeF64>();
        let with_obvhs = ours
            .offering::<ObvhsBvh2<Native>>("obvhs-bvh2", ObvhsConfig::default())
            .offering::<ObvhsBvh2<Over<MollerTrumbore>>>("obvhs-bvh2", ObvhsConfig::default())
            .offering::<ObvhsBvh2<Over<Exact>>>("obvhs-bvh2", ObvhsConfig::default())
            .offering::<ObvhsCwBvh<Native>>("obvhs-cwbvh", ObvhsConfig::default())
            .offering::<ObvhsCwBvh<Over<MollerTrumbore>>>("obvhs-cwbvh", ObvhsConfig::default())
            .offering::<ObvhsCwBvh<Over<Exact>>>("obvhs-cwbvh", ObvhsConfig::default())
            .brute_force::<RtTest>();
        with_obvhs.with_peers()
    }

    /// Brute force over the triangle test `T`, which structures over it are held against.
    fn brute_force<T: Judged>(self) -> Self
    where
        BruteForce<T>: Offered<Config = BruteForceConfig>,
    {
        self.offering::<BruteForce<T>>("brute-force", BruteForceConfig::default())
    }

    /// The structures of this crate over the triangle test `T`.
    fn over<T: Judged>(self) -> Self
    where
        BruteForce<T>: Offered<Config = BruteForceConfig>,
        KdTree<T>: Offered<Config = KdConfig>,
        Bvh8<T>: Offered<Config = Bvh8Config>,
    {
        self.brute_force::<T>()
            .offering::<KdTree<T>>("median-kd", KdConfig::REPORT)
            .offering::<KdTree<T>>("sah-kd", KdConfig::SAH)
            .offering::<Bvh8<T>>("sah-kd-wide", Bvh8Config::new(Partition::Cells))
            .offering::<Bvh8<T>>("sah-kd-tight", Bvh8Config::new(Partition::Tight))
            .offering::<Bvh8<T>>("sah-hybrid", Bvh8Config::new(Partition::Hybrid))
            .offering::<Bvh8<T>>("sah-bvh", Bvh8Config::new(Partition::Objects))
    }

    /// Adds a structure under `name`, with `config` as what a user gets who names no keys.
    ///
    /// # Panics
    /// If `name` is `all` or holds a character that the command line gives a meaning (`:`, `,`, `=` or white space), if the name
    /// is taken for the same triangle test, or if `config` does not serialise to a map of keys.
    pub fn with<A: Accel>(self, name: &str, config: A::Config) -> Self {
        self.entered::<A>(name, config, |mesh, config| Ok(Box::new(A::build(mesh, config)?)))
    }

    /// As [`with`](Self::with), for what is compiled elsewhere.
    fn offering<A: Offered>(self, name: &str, config: A::Config) -> Self {
        self.entered::<A>(name, config, A::boxed)
    }

    fn entered<A: Accel>(mut self, name: &str, config: A::Config, build: fn(&Arc<Mesh>, &A::Config) -> Built) -> Self {
        assert!(
            !name.is_empty() && name != "all" && !name.contains([':', ',', '=', ' ', '\t', '\n']),
            "the name {name:?} must not be \"all\" nor hold ':', ',', '=' or white space"
        );
        let test = A::TRIANGLE_TEST;
        let taken = self.entries.iter().any(|e| e.name == name && e.triangle_test == test);
        assert!(!taken, "there is already a structure {name:?} over the test {test:?}");
        let config = match serde_json::to_value(config).expect("a configuration serialises") {
            Value::Null => Value::Object(Map::new()),
            value @ Value::Object(_) => value,
            other => panic!("the configuration of {name:?} must be a struct with named fields, not {other}"),
        };
        let build: Build = Arc::new(move |mesh, config| {
            let config = parse::<A>(config).map_err(BuildError::Config)?;
            // Builders of other crates may panic on a mesh that they did not expect; one structure must not end a run.
            panic::catch_unwind(AssertUnwindSafe(|| build(mesh, &config))).unwrap_or(Err(BuildError::Panic))
        });
        self.entries.push(Entry {
            name: name.into(),
            triangle_test: A::TRIANGLE_TEST,
            observed: A::OBSERVED,
            conventions: A::CONVENTIONS,
            capabilities: A::CAPABILITIES,
            config,
            read: |config| parse::<A>(config).map(drop),
            build,
        });
        self
    }

    /// All entries, in order.
    pub fn entries(&self) -> &[Entry] {
        &self.entries
    }

    /// The entry `name` over `test`.
    pub fn find(&self, name: &str, test: &str) -> Option<&Entry> {
        self.entries.iter().find(|e| e.name == name && e.triangle_test == test)
    }

    /// Reads `NAME` or `NAME:key=value,..`. The key `test` chooses the triangle test; without it the first entry of that
    /// name is taken.
    ///
    /// # Errors
    /// If the name, a key or the test is unknown, listing those there are; or if a value does not fit.
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
        let entry = match test {
            None => first,
            Some(test) => {
                named.iter().find(|e| e.triangle_test.eq_ignore_ascii_case(test)).copied().ok_or_else(|| {
                    ChoiceError::Test {
                        name: first.name.clone(),
                        test: test.into(),
                        suggestion: suggestion(test, named.iter().map(|e| e.triangle_test)),
                        known: named.iter().map(|e| e.triangle_test).collect::<Vec<_>>().join(", "),
                    }
                })?
            }
        };
        entry.configure(&overrides, !std::ptr::eq(entry, first))
    }

    /// The default choice of every entry, in order.
    pub fn all(&self) -> Vec<Choice> {
        let first = |e: &Entry| self.entries.iter().find(|f| f.name == e.name).is_some_and(|f| std::ptr::eq(f, e));
        self.entries.iter().map(|e| e.configure(&[], !first(e)).expect("a default configuration is accepted")).collect()
    }

    /// Names without repetition, in order.
    pub fn names(&self) -> Vec<&str> {
        let mut names: Vec<&str> = vec![];
        for entry in &self.entries {
            if !names.contains(&entry.name.as_str()) {
                names.push(&entry.name);
            }
        }
        names
    }
}

impl Entry {
    /// The default configuration, by key.
    pub fn config(&self) -> &Value {
        &self.config
    }

    /// Why the structure cannot take part on this system; nothing if it can.
    pub fn absence(&self) -> Option<String> {
        match (self.build)(&Arc::new(empty()), &self.config) {
            Err(BuildError::Unavailable(sentence)) => Some(sentence),
            _ => None,
        }
    }

    fn configure(&self, overrides: &[(&str, &str)], name_test: bool) -> Result<Choice, ChoiceError> {
        let mut config = self.config.clone();
        let keys = config.as_object_mut().expect("checked when it was registered");
        let mut shown = vec![];
        if name_test {
            shown.push(format!("test={}", self.triangle_test));
        }
        for &(key, text) in overrides {
            let known: Vec<&str> = keys.keys().map(String::as_str).collect();
            let unknown = || ChoiceError::Key {
                name: self.name.clone(),
                key: key.into(),
                suggestion: suggestion(key, known.iter().copied()),
                known: known.join(", "),
            };
            if !keys.contains_key(key) {
                return Err(unknown());
            }
            let value = serde_json::from_str(text).unwrap_or_else(|_| Value::String(text.into()));
            self.takes(key, &value).map_err(|reason| {
                let values = self.values(key);
                ChoiceError::Value {
                    name: self.name.clone(),
                    given: format!("{key}={text}"),
                    reason: reason.split(", expected").next().unwrap_or_default().into(),
                    suggestion: suggestion(text, values.split(", ")),
                    values,
                }
            })?;
            if keys[key] != value {
                shown.push(format!("{key}={text}"));
            }
            keys.insert(key.into(), value);
        }
        let label = if shown.is_empty() { self.name.clone() } else { format!("{}:{}", self.name, shown.join(",")) };
        let choice = Choice { entry: self.clone(), config, label };
        match choice.build(&Arc::new(empty())) {
            Err(BuildError::Config(reason)) => Err(ChoiceError::Config { name: self.name.clone(), reason }),
            // What is absent, or cannot do with the empty mesh, is refused when it is built over a mesh: it must not end a run
            // over many.
            _ => Ok(choice),
        }
    }

    /// Whether a key can have a value, whatever the others have; the error is the reader's.
    fn takes(&self, key: &str, value: &Value) -> Result<(), String> {
        let mut config = self.config.clone();
        config[key] = value.clone();
        (self.read)(&config)
    }
}

impl Choice {
    /// # Errors
    /// If the structure does not admit the mesh.
    pub fn build(&self, mesh: &Arc<Mesh>) -> Result<Box<dyn DynAccel>, BuildError> {
        (self.entry.build)(mesh, &self.config)
    }

    /// The structure as the functions of [`crate::validate::conformance`] take it.
    pub fn subject(&self) -> Subject {
        let own = self.clone();
        Subject::new(&self.label, self.triangle_test(), move |mesh| own.build(mesh))
    }

    /// The triangle test whose answers this structure gives.
    pub fn triangle_test(&self) -> &'static str {
        self.entry.triangle_test
    }
}

fn empty() -> Mesh {
    Mesh::new(vec![], vec![]).expect("the empty mesh is valid")
}

/// A configuration from its map of keys; a type without fields serialises to null.
fn parse<A: Accel>(config: &Value) -> Result<A::Config, String> {
    serde_json::from_value(config.clone()).or_else(|error| match config {
        Value::Object(map) if map.is_empty() => serde_json::from_value(Value::Null).map_err(|_| error.to_string()),
        _ => Err(error.to_string()),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn unknown_names_and_keys_are_answered_with_the_known_ones() {
        let registry = Registry::builtin();
        let error = registry.choose("brute").map(|_| ()).unwrap_err().to_string();
        assert!(error.contains("\"brute\"") && error.contains("brute-force"), "{error}");
        let error = registry.choose("brute-force:leaf=3").map(|_| ()).unwrap_err();
        assert!(matches!(error, ChoiceError::Key { .. }), "{error}");
        let error = registry.choose("brute-force:leaf").map(|_| ()).unwrap_err();
        assert!(matches!(error, ChoiceError::Form { .. }), "{error}");
        let error = registry.choose("brute-force:test=none").map(|_| ()).unwrap_err();
        assert!(matches!(error, ChoiceError::Test { .. }), "{error}");
    }

    /// Cannot do with the empty mesh, by a panic or by a sentence.
    struct NeedsTriangles<const PANICS: bool>;

    impl<const PANICS: bool> Accel for NeedsTriangles<PANICS> {
        type Config = ();

        fn build(mesh: &Arc<Mesh>, (): &()) -> Result<Self, BuildError> {
            match mesh.is_empty() {
                true if PANICS => panic!("a tree has a root"),
                true => Err(BuildError::Mesh("a tree has a root".into())),
                false => Ok(Self),
            }
        }

        fn closest_hit<O: crate::accel::Observer>(
            &self,
            _: &crate::geometry::Ray,
            _: &mut O,
        ) -> Option<crate::geometry::Hit> {
            None
        }

        fn footprint(&self) -> crate::accel::Footprint {
            Default::default()
        }

        fn shape(&self) -> crate::accel::TreeShape {
            Default::default()
        }
    }

    #[test]
    fn what_cannot_do_with_the_empty_mesh_is_chosen_all_the_same() {
        let registry = Registry::builtin().with::<NeedsTriangles<true>>("a", ()).with::<NeedsTriangles<false>>("b", ());
        assert_eq!(registry.all().len(), registry.entries().len());
        for name in ["a", "b"] {
            let choice = registry.choose(name).unwrap();
            assert!(choice.build(&Arc::new(empty())).is_err());
            assert!(choice.entry.absence().is_none());
        }
    }

    #[test]
    fn labels_name_only_what_differs() {
        let choice = Registry::builtin().choose("brute-force:test=exact").unwrap();
        assert_eq!(choice.label, "brute-force");
    }
}
