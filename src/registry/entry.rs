use std::sync::Arc;

use serde_json::Value;

use crate::accel::{BuildError, Capabilities, DynAccel, Observed};
use crate::geometry::Mesh;

/// One structure over one triangle test, with its default configuration.
#[derive(Clone)]
pub struct Entry {
    /// As written on the command line; entries of one structure over several tests share it.
    pub name: String,
    /// [`Accel::TRIANGLE_TEST`](crate::accel::Accel::TRIANGLE_TEST).
    pub triangle_test: &'static str,
    /// [`Accel::OBSERVED`](crate::accel::Accel::OBSERVED).
    pub observed: Observed,
    /// [`Accel::CONVENTIONS`](crate::accel::Accel::CONVENTIONS).
    pub conventions: &'static [&'static str],
    /// [`Accel::CAPABILITIES`](crate::accel::Accel::CAPABILITIES).
    pub capabilities: Capabilities,
    pub(super) config: Value,
    /// Whether a configuration can be read, before it is known whether its values go together.
    pub(super) read: fn(&Value) -> Result<(), String>,
    pub(super) build: Build,
}

pub(super) type Built = Result<Box<dyn DynAccel>, BuildError>;
/// Builds over a mesh with a configuration by key.
pub(super) type Build = Arc<dyn Fn(&Arc<Mesh>, &Value) -> Built + Send + Sync>;

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

    /// Whether a key can have a value, whatever the others have; the error is the reader's.
    pub(super) fn takes(&self, key: &str, value: &Value) -> Result<(), String> {
        let mut config = self.config.clone();
        config[key] = value.clone();
        (self.read)(&config)
    }
}

/// What shows whether a configuration is accepted.
pub(super) fn empty() -> Mesh {
    Mesh::new(vec![], vec![]).expect("the empty mesh is valid")
}
