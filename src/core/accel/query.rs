//! The queries of rays: closest hit and any hit.

use serde::{Deserialize, Serialize};

/// The query for each ray of a batch.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Query {
    /// The nearest hit of each ray.
    #[default]
    Closest,
    /// Whether each ray hits anything.
    Any,
}

impl Query {
    /// The name in exports.
    pub fn name(self) -> &'static str {
        match self {
            Self::Closest => "closest",
            Self::Any => "any",
        }
    }
}
