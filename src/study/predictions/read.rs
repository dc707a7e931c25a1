//! What other studies have left in a folder.

use std::fs;
use std::path::Path;

use serde::Deserialize;
use serde::de::DeserializeOwned;

use super::Inputs;
use crate::measure::Estimate;
use crate::report::Record;
use crate::study::journal::{Journal, JournalError};
use crate::study::{attribution, crossover, scaling};

/// What is needed of `replicate.json`.
#[derive(Clone, Debug, PartialEq, Deserialize)]
pub struct Replicated {
    pub main: Vec<Main>,
}

/// An easy or normal scene.
#[derive(Clone, Debug, PartialEq, Deserialize)]
pub struct Main {
    pub scene: String,
    pub triangles: usize,
    pub brute_force: Seconds,
    pub improvement: Estimate,
}

/// Seconds / (rays x triangles).
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
pub struct Seconds {
    pub t_prime: Estimate,
}

/// Reads what `folder` holds; what is not there is left empty. What is counted here is added by the caller.
///
/// # Errors
/// If a file is there and is not what it should be.
pub fn read(folder: &Path) -> Result<Inputs, JournalError> {
    Ok(Inputs {
        counted: vec![],
        replicated: json(&folder.join("replicate.json"))?,
        attribution: attribution::result(&journal(folder, attribution::NAME)?),
        scaling: scaling::result(&journal(folder, scaling::NAME)?),
        crossover: crossover::result(&journal(folder, crossover::NAME)?),
        compare: json::<Vec<Record>>(&folder.join("compare.json"))?.unwrap_or_default(),
    })
}

/// The cases of a journal, none where there is none.
fn journal<C: serde::Serialize + DeserializeOwned>(folder: &Path, study: &str) -> Result<Vec<C>, JournalError> {
    let path = folder.join(format!("{study}.jsonl"));
    if !path.exists() {
        return Ok(vec![]);
    }
    Ok(Journal::<C>::read(&path, study)?.cases)
}

fn json<T: DeserializeOwned>(path: &Path) -> Result<Option<T>, JournalError> {
    if !path.exists() {
        return Ok(None);
    }
    let bytes = fs::read(path).map_err(|cause| JournalError::Read { path: path.into(), cause })?;
    let parsed = serde_json::from_slice(&bytes);
    parsed.map(Some).map_err(|error| JournalError::Json { path: path.into(), problem: error.to_string() })
}
