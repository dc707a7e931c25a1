//! The journal of a study: a folder with one file per scene and epoch. A killed run resumes where it
//! stopped, and several machines can write to one folder without communicating.
//!
//! Each file holds the case, its provenance and its results. One writer writes it whole, and it never changes. A file
//! name that begins with a dot marks an unfinished write and is ignored. A case file's name has the case's key and
//! a digest of settings, build and machine, so that cases of any settings lie side by side. Anybody may read at any time,
//! and any number of planned jobs may write; only one run at a time may measure the missing cases.

mod case_file;
mod error;
mod newest;

use std::fs::{self, File, TryLockError};
use std::path::{Path, PathBuf};

use super::case::Case;
use crate::measure::Provenance;
pub use case_file::CaseFile;
pub use error::JournalError;
pub use newest::{datasets, newest, of_all};

/// A folder of cases, and those of them that one build has measured on one machine.
#[derive(Debug)]
pub struct Journal {
    folder: PathBuf,
    /// Of this process: cases of another build or machine are not its own.
    provenance: Provenance,
    files: Vec<CaseFile>,
    /// Number of leading `files` to ignore: with `fresh`, those present when the journal was opened; otherwise 0.
    ignored: usize,
    /// The folder, locked while a run measures into it. The system lets go of it when the process ends, however that happens.
    _lock: Option<File>,
}

impl Journal {
    /// Opens the journal in `folder`, and makes the folder where there is none. With `fresh` the cases there are measured
    /// again: they stay, and the newest count.
    ///
    /// # Errors
    /// If what is there cannot be read, or the folder cannot be made.
    pub fn open(folder: &Path, provenance: Provenance, fresh: bool) -> Result<Self, JournalError> {
        fs::create_dir_all(folder).map_err(|cause| JournalError::Write { path: folder.into(), cause })?;
        let files = files(folder)?.iter().map(|path| CaseFile::read(path)).collect::<Result<Vec<_>, _>>()?;
        let ignored = if fresh { files.len() } else { 0 };
        Ok(Self { folder: folder.into(), provenance, files, ignored, _lock: None })
    }

    /// As [`open`](Self::open), for a run that measures those of `cases` that are not there. One at a time does so: two
    /// would measure the same cases, and disturb each other's times.
    ///
    /// # Errors
    /// Likewise, and if something is to be measured while another run measures into the folder.
    pub fn open_to_measure(
        folder: &Path,
        provenance: Provenance,
        fresh: bool,
        cases: &[Case],
    ) -> Result<Self, JournalError> {
        fs::create_dir_all(folder).map_err(|cause| JournalError::Write { path: folder.into(), cause })?;
        // Take the lock before reading the cases, so that they include everything an earlier run wrote.
        let lock = File::open(folder).ok();
        // Where folders cannot be locked, as on Windows and on many network file systems, nobody is kept out.
        let is_taken = lock.as_ref().is_some_and(|own| matches!(own.try_lock(), Err(TryLockError::WouldBlock)));
        let journal = Self::open(folder, provenance, fresh)?;
        if cases.iter().all(|case| journal.get(case).is_some()) {
            return Ok(journal);
        }
        if is_taken { Err(JournalError::Busy(folder.into())) } else { Ok(Self { _lock: lock, ..journal }) }
    }

    /// The newest file of the case, as this build would measure it on this machine.
    pub fn get(&self, case: &Case) -> Option<&CaseFile> {
        let machine = self.provenance.machine();
        let own = self.files[self.ignored..].iter();
        own.filter(|file| file.case.is_same(case) && file.provenance.machine() == machine)
            .max_by(|a, b| a.provenance.date.cmp(&b.provenance.date))
    }

    /// Where a file for the case goes, one that is not there yet.
    pub fn place(&self, case: &Case) -> PathBuf {
        let name = file_name(case, &self.provenance);
        let again = (2..).map(|n| format!("{name}-{n}"));
        let mut names = std::iter::once(name.clone()).chain(again).map(|name| self.folder.join(name + ".json"));
        names.find(|path| !path.exists()).expect("there are more numbers than files")
    }

    /// Takes up what has been written at `path`.
    ///
    /// # Errors
    /// If it cannot be read.
    pub fn add(&mut self, path: &Path) -> Result<(), JournalError> {
        self.files.push(CaseFile::read(path)?);
        Ok(())
    }
}

/// The name of the file of a case, without its ending: small letters, digits and hyphens.
pub fn file_name(case: &Case, provenance: &Provenance) -> String {
    let plain = |c: char| if c.is_ascii_alphanumeric() { c.to_ascii_lowercase() } else { '-' };
    let words: String = case.key().chars().map(plain).collect();
    let words: Vec<&str> = words.split('-').filter(|word| !word.is_empty()).collect();
    let name: String = words.join("-").chars().take(LONGEST).collect();
    format!("{}-{}", name.trim_end_matches('-'), case.digest(&provenance.machine()))
}

/// Characters of a name before what tells it from others, at most.
const LONGEST: usize = 100;

/// The files of a folder that may be cases, by name.
///
/// # Errors
/// If it cannot be read.
pub fn files(folder: &Path) -> Result<Vec<PathBuf>, JournalError> {
    let unreadable = |cause| JournalError::Read { path: folder.into(), cause };
    let mut found = vec![];
    for entry in fs::read_dir(folder).map_err(unreadable)? {
        let entry = entry.map_err(unreadable)?;
        let is_hidden = entry.file_name().as_encoded_bytes().starts_with(b".");
        let path = entry.path();
        if !is_hidden && path.extension().is_some_and(|ending| ending == "json") && path.is_file() {
            found.push(path);
        }
    }
    found.sort();
    Ok(found)
}

#[cfg(test)]
mod tests;
