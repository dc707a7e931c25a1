//! What a study found, in a sentence.

use serde::Serialize;

use crate::measure::Estimate;

/// A sentence that the data choose and fill in: the page, `papers/RESULTS.md` and README all print the same one.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Statement {
    /// Letters, digits and hyphens; no two statements of a study share one.
    pub key: String,
    /// Ends with a full stop.
    pub sentence: String,
    /// The number that the sentence is about, where it is about one.
    pub value: Option<Estimate>,
}

impl Statement {
    /// A statement without a number of its own.
    pub fn new(key: &str, sentence: impl Into<String>) -> Self {
        Self { key: key.into(), sentence: sentence.into(), value: None }
    }

    /// The same statement, about `value`.
    pub fn of(self, value: Estimate) -> Self {
        Self { value: Some(value), ..self }
    }
}
