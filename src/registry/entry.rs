use std::sync::Arc;

use serde_json::Value;

use crate::accel::{BuildError, Capabilities, DynAccel, Observed};
use crate::geometry::Mesh;

/// An acceleration structure with one ray-triangle intersection test.
#[derive(Clone)]
pub struct Entry {
    /// The name of the structure on the command line. Entries that differ only in the triangle test have the same name.
    pub name: String,
    pub triangle_test: &'static str,
    pub observed: Observed,
    /// [`Accel::CONVENTIONS`](crate::accel::Accel::CONVENTIONS).
    pub conventions: &'static [&'static str],
    pub capabilities: Capabilities,
    /// Whether this crate registers the structure.
    pub is_builtin: bool,
    /// The default configuration, as a JSON object.
    pub config: Value,
    /// Checks that a configuration can be parsed. Contradictions between values are not detected.
    pub(super) read: fn(&Value) -> Result<(), String>,
    pub(super) build: Build,
}

pub(super) type BuildResult = Result<Box<dyn DynAccel>, BuildError>;
pub(super) type Build = Arc<dyn Fn(&Arc<Mesh>, &Value) -> BuildResult + Send + Sync>;

impl Entry {
    /// The reason why the structure cannot run on this system.
    pub fn absence(&self) -> Option<String> {
        match (self.build)(&Arc::new(empty()), &self.config) {
            Err(BuildError::Unavailable(sentence)) => Some(sentence),
            _ => None,
        }
    }

    /// Checks that the parser accepts `value` for `key`, with defaults for all other keys.
    pub(super) fn takes(&self, key: &str, value: &Value) -> Result<(), String> {
        let mut config = self.config.clone();
        config[key] = value.clone();
        (self.read)(&config)
    }
}

/// The empty mesh, for builds that only check the configuration or the system.
pub(super) fn empty() -> Mesh {
    Mesh::new(vec![], vec![]).expect("the empty mesh is valid")
}
