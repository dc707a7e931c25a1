use std::io;
use std::path::{Path, PathBuf};

use crate::escaped::Escaped as _;
use crate::output::OutputError;

/// An error while a journal or a case file is read or written.
#[derive(Debug, thiserror::Error)]
pub enum JournalError {
    #[error("cannot read {}: {cause}: name a folder that a study has written", path.escaped())]
    Read { path: PathBuf, cause: io::Error },
    #[error(
        "cannot write {}: {cause}: earlier results are kept; free some space, or choose another folder with --dir",
        path.escaped()
    )]
    Write { path: PathBuf, cause: io::Error },
    #[error(
        "another run is measuring into {}: repeat this command when it has finished, or choose another folder with \
         --dir",
        .0.escaped()
    )]
    Busy(PathBuf),
    #[error(transparent)]
    Place(OutputError),
    #[error("{} is not a case of a study: move it away, or name another folder", .0.escaped())]
    Foreign(PathBuf),
    #[error("{} contains another case: name another file with --out", .0.escaped())]
    Other(PathBuf),
    #[error(
        "{} has version {there} of the case format, but this sahara uses version {here}: choose another folder, or \
         measure again",
        path.escaped()
    )]
    Schema { path: PathBuf, there: u32, here: u32 },
    #[error("{} cannot be parsed: {problem}; remove it and repeat the command that wrote it", path.escaped())]
    Damaged { path: PathBuf, problem: String },
}

impl JournalError {
    /// Omits line and column, because a case file is one long line.
    pub fn damaged(path: &Path, cause: &serde_json::Error) -> Self {
        let text = cause.to_string();
        let problem = text.split(" at line ").next().unwrap_or(&text).to_owned();
        Self::Damaged { path: path.into(), problem }
    }
}
