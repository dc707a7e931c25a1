//! The journal of a study is a folder of case files. A case is one epoch of one scene.
//!
//! Each file is written atomically and never changed. A file name that begins with a dot marks an unfinished write.
//! File names contain a digest of settings, build and machine. Any process may read at any time. Any number of jobs of
//! `study plan` may write. Only one run at a time may measure the missing cases.

mod case_file;
mod error;
mod newest;

use std::fs::{self, File, TryLockError};
use std::io;
use std::path::{Path, PathBuf};

use super::case::Case;
use crate::measure::Provenance;
pub use case_file::CaseFile;
pub use error::JournalError;
pub use newest::{datasets, newest, of_all};

#[derive(Debug)]
pub struct Journal {
    folder: PathBuf,
    provenance: Provenance,
    files: Vec<CaseFile>,
    /// [`get`](Self::get) ignores this number of files at the beginning of `files`.
    ignored: usize,
    /// The lock on the folder. The system releases the lock when the process ends.
    _lock: Option<File>,
}

impl Journal {
    /// With `fresh`, existing files are ignored. Returns [`JournalError::Busy`] if cases are missing and another run
    /// has locked the folder. Two simultaneous runs would disturb each other's times.
    pub fn open(folder: &Path, provenance: Provenance, fresh: bool, cases: &[Case]) -> Result<Self, JournalError> {
        fs::create_dir_all(folder).map_err(|cause| JournalError::Write { path: folder.into(), cause })?;
        // Lock the folder before reading it. Otherwise, another run could add files after the reading and end before
        // the locking.
        let lock = File::open(folder).ok();
        // Windows and many network file systems cannot lock folders. On these systems, a run continues without a lock.
        let is_taken = lock.as_ref().is_some_and(|own| matches!(own.try_lock(), Err(TryLockError::WouldBlock)));
        let files = files(folder)?.iter().map(|path| CaseFile::read(path)).collect::<Result<Vec<_>, _>>()?;
        let ignored = if fresh { files.len() } else { 0 };
        let journal = Self { folder: folder.into(), provenance, files, ignored, _lock: lock };
        match cases.iter().all(|case| journal.get(case).is_some()) {
            true => Ok(Self { _lock: None, ..journal }),
            false if is_taken => Err(JournalError::Busy(folder.into())),
            false => Ok(journal),
        }
    }

    /// Returns the newest file of `case` with the build and machine of this run.
    pub fn get(&self, case: &Case) -> Option<&CaseFile> {
        let machine = self.provenance.machine();
        let own = self.files[self.ignored..].iter();
        own.filter(|file| file.case.is_same(case) && file.provenance.machine() == machine)
            .max_by(|a, b| a.provenance.date.cmp(&b.provenance.date))
    }

    pub fn place(&self, case: &Case) -> PathBuf {
        let name = file_name(case, &self.provenance);
        let again = (2..).map(|n| format!("{name}-{n}"));
        let mut names = std::iter::once(name.clone()).chain(again).map(|name| self.folder.join(name + ".json"));
        names.find(|path| !path.exists()).expect("there are more numbers than files")
    }

    pub fn add(&mut self, path: &Path) -> Result<(), JournalError> {
        self.files.push(CaseFile::read(path)?);
        Ok(())
    }
}

/// The file name without extension, in lower-case letters, digits and hyphens.
pub fn file_name(case: &Case, provenance: &Provenance) -> String {
    let plain = |c: char| if c.is_ascii_alphanumeric() { c.to_ascii_lowercase() } else { '-' };
    let words: String = case.key().chars().map(plain).collect();
    let words: Vec<&str> = words.split('-').filter(|word| !word.is_empty()).collect();
    let name: String = words.join("-").chars().take(LONGEST).collect();
    format!("{}-{}", name.trim_end_matches('-'), case.digest(&provenance.machine()))
}

const LONGEST: usize = 100;

pub fn files(folder: &Path) -> Result<Vec<PathBuf>, JournalError> {
    let paths = fs::read_dir(folder).and_then(|all| all.map(|entry| Ok(entry?.path())).collect::<io::Result<Vec<_>>>());
    let mut paths = paths.map_err(|cause| JournalError::Read { path: folder.into(), cause })?;
    let is_hidden = |path: &PathBuf| path.file_name().is_some_and(|name| name.as_encoded_bytes().starts_with(b"."));
    paths.retain(|path| !is_hidden(path) && path.extension().is_some_and(|ending| ending == "json") && path.is_file());
    paths.sort();
    Ok(paths)
}

#[cfg(test)]
mod tests;
