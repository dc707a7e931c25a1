use std::path::PathBuf;

use crate::escaped::Escaped as _;
use crate::study::journal::JournalError;

/// Why runs cannot be read.
#[derive(Debug, thiserror::Error)]
pub enum RunError {
    #[error("{} is JSON but no run of sahara: name files of `--export-json`, or of a study", path.escaped())]
    Foreign { path: PathBuf },
    #[error("{} is of the study {study:?}, which this sahara does not know: leave it out", path.escaped())]
    Unknown { path: PathBuf, study: String },
    #[error(transparent)]
    Journal(#[from] JournalError),
    #[error(
        "there is no run in {}: `sahara study all` makes a whole one, `sahara compare --export-json {}/compare.json` a \
         small one",
        path.escaped(),
        path.escaped()
    )]
    Empty { path: PathBuf },
}
