use std::io;
use std::path::PathBuf;

use crate::escaped::Escaped as _;
use crate::output::OutputError;

/// Why a journal, or a case of one, cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum JournalError {
    #[error("cannot read {}: {cause}: name what a study has written", path.escaped())]
    Read { path: PathBuf, cause: io::Error },
    #[error(
        "cannot write {}: {cause}: what was measured before is kept; give it room, or name another folder with --dir",
        path.escaped()
    )]
    Write { path: PathBuf, cause: io::Error },
    #[error(
        "another run is measuring into {}: give the same command again when it has ended, or name another folder with --dir",
        .0.escaped()
    )]
    Busy(PathBuf),
    #[error(transparent)]
    Place(OutputError),
    #[error("{} is not a case of a study: move it away, or name another place", .0.escaped())]
    Foreign(PathBuf),
    #[error("{} is a case of the study {there}, not of {here}: name another place", path.escaped())]
    Study { path: PathBuf, there: String, here: String },
    #[error("{} holds the case {there:?}, not {here:?}: name another place", path.escaped())]
    Key { path: PathBuf, there: String, here: String },
    #[error("{} and {} hold the same case {key:?}: move one of them away", paths[0].escaped(), paths[1].escaped())]
    Twice { paths: [PathBuf; 2], key: String },
    #[error(
        "{} has version {there} of the form of cases, this sahara writes version {here}: --fresh starts anew, or name another folder \
         with --dir",
        path.escaped()
    )]
    Schema { path: PathBuf, there: u32, here: u32 },
    #[error(
        "{} was measured with other settings: {differences}; give the same ones to go on, --fresh to start anew, or another folder \
         with --dir",
        path.escaped()
    )]
    Settings { path: PathBuf, differences: String },
    #[error(
        "{} was measured by another build or on another machine: {differences}; it is not what this sahara measures: --fresh starts anew, \
         --dir names another folder, and `sahara report` shows it as it is",
        path.escaped()
    )]
    Machine { path: PathBuf, differences: String },
    #[error(
        "{} and {} are cases of the study {study} with other settings: {differences}; report them apart, or measure one of them anew",
        paths[0].escaped(),
        paths[1].escaped()
    )]
    Conflict { paths: Box<[PathBuf; 2]>, study: String, differences: String },
    #[error("{} does not read: {problem}; remove it to measure its case again, or --fresh starts anew", path.escaped())]
    Damaged { path: PathBuf, problem: String },
}
