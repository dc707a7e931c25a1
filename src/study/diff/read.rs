//! Reads a run from an export or from a folder of journals.

use std::path::Path;

use serde_json::Value;

use crate::escaped::Escaped as _;
use crate::study::Dataset;
use crate::study::journal::{CaseFile, JournalError, files, newest};

/// If a folder has cases of `compare`, cases of other studies are ignored.
pub fn read(path: &Path) -> anyhow::Result<Dataset> {
    let found = if path.is_dir() { of_folder(path)? } else { Some(of_export(path)?) };
    let found = found.filter(|own| !own.measured.is_empty());
    found.ok_or_else(|| anyhow::anyhow!("{} has no results: {ADVICE}", path.escaped()))
}

const ADVICE: &str = "name a file of `--export-json` or a folder of `--dir`";

fn of_folder(path: &Path) -> anyhow::Result<Option<Dataset>> {
    let mut paths = files(path)?;
    for entry in std::fs::read_dir(path)?.flatten().filter(|entry| entry.path().is_dir()) {
        paths.extend(files(&entry.path())?);
    }
    let mut cases = vec![];
    for path in paths {
        match CaseFile::read(&path) {
            Ok(case) => cases.push(case),
            // JSON files that are not cases are ignored, for example exports.
            Err(JournalError::Foreign(_)) => {}
            Err(error) => return Err(error.into()),
        }
    }
    if cases.iter().any(|own: &CaseFile| own.case.study == "compare") {
        cases.retain(|own| own.case.study == "compare");
    }
    Ok(newest(cases))
}

fn of_export(path: &Path) -> anyhow::Result<Dataset> {
    let text =
        std::fs::read(path).map_err(|cause| anyhow::anyhow!("cannot read {} ({cause}): {ADVICE}", path.escaped()))?;
    let value: Value = serde_json::from_slice(&text)
        .map_err(|cause| anyhow::anyhow!("{} is truncated or not JSON ({cause}): {ADVICE}", path.escaped()))?;
    anyhow::ensure!(Dataset::is_dataset(&value), "{} is not an export of a study: {ADVICE}", path.escaped());
    Ok(Dataset::read(path, value)?)
}
