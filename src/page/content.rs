//! What a file or folder of runs holds.

use std::fs;
use std::path::{Path, PathBuf};
use std::time::SystemTime;

use serde_json::Value;

use super::run_error::RunError;
use crate::study::journal::{self, CaseFile, is_case};
use crate::study::{AnyAnswer, AnyStudy, Studies};

/// What a file holds.
pub(super) enum Content<'a> {
    Export(&'a dyn AnyStudy, AnyAnswer),
    Case(&'a dyn AnyStudy, Box<CaseFile<Value>>),
}

/// What the file `path` holds.
///
/// # Errors
/// If it is torn, foreign or of another version.
pub(super) fn content<'a>(path: &Path, studies: &'a Studies) -> Result<Content<'a>, RunError> {
    let text = fs::read_to_string(path).map_err(|cause| RunError::Read { path: path.into(), cause })?;
    let value: Value = serde_json::from_str(&text).map_err(|cause| RunError::Torn { path: path.into(), cause })?;
    if is_case(&value) {
        let case = CaseFile::of(path, value)?;
        let name = case.header.study.clone();
        let study = studies.find(&name).ok_or_else(|| RunError::Unknown { path: path.into(), study: name })?;
        return Ok(Content::Case(study, Box::new(case)));
    }
    for study in studies.iter() {
        if let Some(read) = study.read_export(&value) {
            let form = |cause| RunError::Form { path: path.into(), study: study.name(), cause };
            return Ok(Content::Export(study, read.map_err(form)?));
        }
    }
    Err(RunError::Foreign { path: path.into() })
}

/// When a file was last written.
///
/// # Errors
/// If the system does not tell.
pub(super) fn modified(path: &Path) -> Result<SystemTime, RunError> {
    let modified = fs::metadata(path).and_then(|meta| meta.modified());
    modified.map_err(|cause| RunError::Read { path: path.into(), cause })
}

/// The files of a folder that may be runs, by name: its own, and those of the journals in it.
///
/// # Errors
/// If it cannot be read.
pub(super) fn folder(path: &Path, studies: &Studies) -> Result<Vec<PathBuf>, RunError> {
    let mut found = journal::files(path)?;
    for study in studies.iter() {
        let cases = path.join(study.name());
        if cases.is_dir() {
            found.extend(journal::files(&cases)?);
        }
    }
    Ok(found)
}
