use std::io;
use std::path::PathBuf;

/// Why a journal cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum JournalError {
    /// It cannot be read.
    #[error("cannot read {}: {cause}: name the file that a study has written", path.display())]
    Read { path: PathBuf, cause: io::Error },
    /// It cannot be written; what was in it still is.
    #[error(
        "cannot write {}: {cause}: what was measured before is kept; give it room, or name another folder with --dir",
        path.display()
    )]
    Write { path: PathBuf, cause: io::Error },
    /// A folder or a device stands where the journal should be.
    #[error("cannot write {}: it is no regular file: remove it, or name another folder with --dir", .0.display())]
    NoFile(PathBuf),
    /// Another process is writing it.
    #[error("{} is being written by another sahara: wait for it, or name another folder with --dir", .0.display())]
    Busy(PathBuf),
    /// It is some other file.
    #[error("{} is not the journal of a study: rename it, or name another folder with --dir", .0.display())]
    Foreign(PathBuf),
    /// It is the journal of another study.
    #[error("{} is the journal of the study {there}, not of {here}: name another folder with --dir", path.display())]
    Study { path: PathBuf, there: String, here: String },
    /// Its form is another version.
    #[error(
        "{} has version {there} of the form of journals, this sahara writes version {here}: --fresh starts anew, or name another \
         folder with --dir",
        path.display()
    )]
    Schema { path: PathBuf, there: u32, here: u32 },
    /// It was begun with other settings.
    #[error(
        "{} was begun with other settings: {differences}; give the same ones to go on, --fresh to start anew, or another folder \
         with --dir",
        path.display()
    )]
    Settings { path: PathBuf, differences: String },
    /// Its cases come from another build or machine.
    #[error(
        "{} was measured by another build or on another machine: {differences}; what it holds is not what this sahara measures: \
         --fresh starts anew, --dir names another folder, and `sahara report` shows it as it is",
        path.display()
    )]
    Machine { path: PathBuf, differences: String },
    /// A whole line does not read.
    #[error(
        "line {line} of {} does not read: {problem}; remove that line to measure its case again, or --fresh starts anew",
        path.display()
    )]
    Damaged { path: PathBuf, line: usize, problem: String },
    /// A file that other commands export does not read.
    #[error("{} is not what sahara exports under that name: {problem}; export it again, or name another folder with --dir", path.display())]
    Json { path: PathBuf, problem: String },
}
