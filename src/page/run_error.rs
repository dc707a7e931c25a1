use std::path::PathBuf;

use crate::escaped::Escaped as _;
use crate::study::journal::JournalError;

/// The reason why runs cannot be read.
#[derive(Debug, thiserror::Error)]
pub enum RunError {
    #[error(
        "{} is JSON, but not a run of sahara: name export files (`--export-json`) or files of a journal",
        path.escaped()
    )]
    Foreign { path: PathBuf },
    #[error("{} belongs to the study {study:?}, which this sahara does not have: omit it", path.escaped())]
    Unknown { path: PathBuf, study: String },
    #[error(transparent)]
    Journal(#[from] JournalError),
    #[error(
        "there is no run in {}: measure one with `sahara study all`, or a small one with `sahara compare \
         --export-json {}/compare.json`",
        path.escaped(),
        path.escaped()
    )]
    Empty { path: PathBuf },
}
