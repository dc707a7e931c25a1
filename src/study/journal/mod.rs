//! The journal of a study: a folder with one file a case, so that a run that is killed goes on where it stopped, and
//! runs of many machines add to one journal without talking to each other.
//!
//! Each file has the case with its key, settings and provenance. It is written whole, by one writer, and never changed:
//! what begins with a dot is being written, or was when its writer was killed, and is no case. Anybody may read at any
//! time, and any number of jobs of a plan may write; of runs that measure all that is missing there is one at a time.

mod case_file;
mod error;
mod groups;
mod header;
mod lock;
#[cfg(test)]
mod tests;
mod versions;

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use crate::measure::Provenance;
use serde::Serialize;

pub use case_file::{CaseFile, Read, SCHEMA, file_name, is_case, place, text, write};
pub use error::JournalError;
use groups::of_all;
pub use groups::{Group, groups};
pub use header::Header;
use lock::Lock;
pub use versions::newest;

/// The cases of a study that are measured, and where those go that will be.
#[derive(Debug)]
pub struct Journal<C> {
    /// Nothing where it is kept in memory alone.
    folder: Option<PathBuf>,
    header: Header,
    /// Of the oldest case, or of this process.
    provenance: Provenance,
    read: Read<C>,
    cases: BTreeMap<String, C>,
    /// Where a run measures.
    _lock: Option<Lock>,
}

impl<C: Serialize> Journal<C> {
    /// A journal that is forgotten when it is dropped.
    pub fn in_memory(header: Header, read: Read<C>) -> Self {
        Self { folder: None, provenance: header.provenance.clone(), header, read, cases: BTreeMap::new(), _lock: None }
    }

    /// Opens the journal in `folder`, to go on with it; makes the folder where there is none. With `fresh` the cases
    /// there are thrown away.
    ///
    /// # Errors
    /// If what is there cannot be read, or is not of this study, of these settings, this build and this machine; or if
    /// the folder cannot be made.
    pub fn open(folder: &Path, header: Header, fresh: bool, read: Read<C>) -> Result<Self, JournalError> {
        let unwritable = |cause| JournalError::Write { path: folder.into(), cause };
        fs::create_dir_all(folder).map_err(unwritable)?;
        let mut journal = Self { folder: Some(folder.into()), ..Self::in_memory(header, read) };
        let files = files(folder)?;
        if fresh {
            files.iter().try_for_each(fs::remove_file).map_err(unwritable)?;
            return Ok(journal);
        }
        let mut paths: BTreeMap<String, PathBuf> = BTreeMap::new();
        let mut all = vec![];
        for path in files {
            let file = CaseFile::read(&path)?;
            journal.header.admits(&file.header, &path)?;
            let CaseFile { header, key, case, .. } = file.typed(read)?;
            if let Some(other) = paths.insert(key.clone(), path.clone()) {
                return Err(JournalError::Twice { paths: [other, path], key });
            }
            all.push(header.provenance);
            journal.cases.insert(key, case);
        }
        if !all.is_empty() {
            journal.provenance = of_all(&all.iter().collect::<Vec<_>>());
        }
        Ok(journal)
    }

    /// As [`open`](Self::open), for a run that measures those of `keys` that are not there. One at a time does so: two
    /// would measure the same cases, and disturb each other's times.
    ///
    /// # Errors
    /// Likewise, and if something is to be measured or thrown away while another run measures into the folder.
    pub fn open_to_measure<'a>(
        folder: &Path,
        header: Header,
        fresh: bool,
        read: Read<C>,
        keys: impl IntoIterator<Item = &'a str>,
    ) -> Result<Self, JournalError> {
        fs::create_dir_all(folder).map_err(|cause| JournalError::Write { path: folder.into(), cause })?;
        // Before the cases are read: what another run has measured until it ended is among them.
        let lock = Lock::take(folder);
        let busy = || JournalError::Busy(folder.into());
        if fresh && lock.is_none() {
            return Err(busy());
        }
        let journal = Self::open(folder, header, fresh, read)?;
        if journal.left(keys).is_empty() {
            return Ok(journal);
        }
        // What is measured now is of its moment as well.
        let provenance = of_all(&[&journal.provenance, &journal.header.provenance]);
        Ok(Self { _lock: Some(lock.ok_or_else(busy)?), provenance, ..journal })
    }

    /// The case `key`, if it has been measured.
    pub fn get(&self, key: &str) -> Option<&C> {
        self.cases.get(key)
    }

    /// Where its cases come from, also where this process has measured none of them.
    pub fn provenance(&self) -> &Provenance {
        &self.provenance
    }

    /// Those of `keys` that are not yet measured.
    pub fn left<'a>(&self, keys: impl IntoIterator<Item = &'a str>) -> Vec<&'a str> {
        keys.into_iter().filter(|key| self.get(key).is_none()).collect()
    }

    /// Keeps a case: when this returns it is on the disk. Where another process has kept it meanwhile, that one's
    /// counts.
    ///
    /// # Errors
    /// If it cannot be written, which leaves the journal as it was.
    ///
    /// # Panics
    /// If there is a case with this key, or the case would not read back.
    pub fn append(&mut self, key: &str, case: C) -> Result<(), JournalError> {
        assert!(self.get(key).is_none(), "the case {key:?} is measured twice");
        let text = text(&self.header, key, &case, self.read);
        let mut case = case;
        if let Some(folder) = &self.folder {
            let file = place(&folder.join(file_name(key)))?;
            if !write(&file, &text)?
                && let Some(there) = CaseFile::there(file.path(), &self.header, key, self.read)?
            {
                case = there.case;
            }
        }
        self.cases.insert(key.into(), case);
        Ok(())
    }

    /// Keeps in `folder` what was kept in memory and is not there: another run of the same cases may have been
    /// interrupted as well.
    ///
    /// # Errors
    /// As [`open`](Self::open) and [`append`](Self::append).
    pub fn keep(self, folder: &Path) -> Result<(), JournalError> {
        let mut kept = Self::open(folder, self.header, false, self.read)?;
        for (key, case) in self.cases {
            if kept.get(&key).is_none() {
                kept.append(&key, case)?;
            }
        }
        Ok(())
    }
}

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
