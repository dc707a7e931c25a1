//! The file of one epoch of one scene, written atomically.

use std::fs;
use std::path::{Path, PathBuf};

use serde::Deserialize;
use serde_json::{Value, json};

use super::JournalError;
use crate::measure::Provenance;
use crate::output::{OutputError, OutputFile};
use crate::study::{Case, Dataset, Epoch};

#[derive(Clone, Debug, PartialEq, Deserialize)]
pub struct CaseFile {
    #[serde(skip)]
    pub path: PathBuf,
    pub provenance: Provenance,
    pub case: Case,
    pub epoch: Epoch,
}

impl CaseFile {
    pub fn read(path: &Path) -> Result<Self, JournalError> {
        let bytes = fs::read(path).map_err(|cause| JournalError::Read { path: path.into(), cause })?;
        let value = serde_json::from_slice(&bytes).map_err(|cause| JournalError::damaged(path, &cause))?;
        if Self::is_case(&value) { Self::of(path, value) } else { Err(JournalError::Foreign(path.into())) }
    }

    /// [`is_case`](Self::is_case) must be true for `value`.
    pub fn of(path: &Path, value: Value) -> Result<Self, JournalError> {
        Dataset::check_schema(path, &value)?;
        let file: Self = serde_json::from_value(value).map_err(|cause| JournalError::damaged(path, &cause))?;
        Ok(Self { path: path.into(), ..file })
    }

    /// Does not check the version of the format.
    pub fn is_case(value: &Value) -> bool {
        ["schema", "provenance", "case"].iter().all(|field| value.get(field).is_some())
    }

    /// Checks that the file can be written.
    pub fn place(path: &Path) -> Result<OutputFile, JournalError> {
        let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty());
        folder.map_or(Ok(()), fs::create_dir_all).map_err(|cause| JournalError::Write { path: path.into(), cause })?;
        OutputFile::check(path).map_err(|error| unwritable(path, error))
    }

    /// Returns false if the file already exists. After an error, no new file exists.
    ///
    /// # Panics
    ///
    /// If the written JSON value cannot be deserialized.
    pub fn write(file: &OutputFile, provenance: &Provenance, case: &Case, epoch: &Epoch) -> Result<bool, JournalError> {
        let value = json!({ "schema": Dataset::SCHEMA, "provenance": provenance, "case": case, "epoch": epoch });
        // In JSON, infinity and NaN become null. Null cannot be read back as a number.
        let read = Self::deserialize(&value);
        assert!(read.is_ok(), "the case does not read back ({:?}): {value}", read.err());
        file.write_new(format!("{value}\n").as_bytes()).map_err(|error| unwritable(&file.path, error))
    }
}

fn unwritable(path: &Path, error: OutputError) -> JournalError {
    match error {
        OutputError::Write { cause, .. } => JournalError::Write { path: path.into(), cause },
        other => JournalError::Place(other),
    }
}
