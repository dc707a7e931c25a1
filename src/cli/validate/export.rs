//! Results as JSON.

use serde::Serialize;
use serde_json::{Value, json};

use super::outcome::Verdicts;
use crate::measure::Provenance;

/// A run; `study/SCHEMA.md` describes it.
#[derive(Debug, Serialize)]
pub struct Export {
    /// Version of this format.
    schema: u32,
    provenance: Provenance,
    /// One per structure.
    verdicts: Vec<Value>,
    /// By scene or case, then by structure.
    results: Vec<Value>,
}

impl Export {
    /// 3: verdicts, and every mode of `validate`.
    const SCHEMA: u32 = 3;

    pub fn new(verdicts: &[Verdicts], results: Vec<Value>) -> Self {
        let verdict =
            |own: &Verdicts| json!({ "label": own.label, "verdict": own.verdict, "sentence": own.sentence() });
        // Every structure traces on one thread.
        let provenance = Provenance::capture(1);
        Self { schema: Self::SCHEMA, provenance, verdicts: verdicts.iter().map(verdict).collect(), results }
    }
}
