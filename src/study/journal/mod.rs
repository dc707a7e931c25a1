//! The journal of a study: what is measured is kept case by case, so that a run that is killed goes on where it stopped.
//!
//! A text file: the first line is the [`Header`], every other one a case, `{"key":"..","case":{..}}`. A case is appended, and
//! forced to the disk, as soon as it is measured. What follows the last line end was being written when the run was killed: it
//! is dropped. One process writes at a time; anybody may read.

mod error;
mod header;
#[cfg(test)]
mod tests;

use std::collections::BTreeMap;
use std::fs::{self, File, OpenOptions, TryLockError};
use std::io::{Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use crate::measure::Provenance;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};

pub use error::JournalError;
pub use header::Header;

/// Name of the journal of `study all`, which holds no measurements: it says which files that run has written.
pub const OF_ALL: &str = "all";

/// A journal that is open for writing. Nobody else can open it so until it is dropped.
#[derive(Debug)]
pub struct Journal<C> {
    path: PathBuf,
    /// Nothing where it is kept in memory alone.
    file: Option<File>,
    /// Bytes of whole lines.
    length: u64,
    recorded: Recorded<C>,
}

/// What a journal holds.
#[derive(Clone, Debug, PartialEq)]
pub struct Recorded<C> {
    pub header: Header,
    /// In the order in which they were measured.
    pub cases: Vec<C>,
    /// Number of each case by its key.
    keys: BTreeMap<String, usize>,
}

/// A line after the first.
#[derive(Serialize, Deserialize)]
struct Line<C> {
    key: String,
    case: C,
}

impl<C: Serialize + DeserializeOwned> Journal<C> {
    /// A journal that is forgotten when it is dropped.
    pub fn in_memory(header: Header) -> Self {
        let recorded = Recorded { header, cases: vec![], keys: BTreeMap::new() };
        Self { path: PathBuf::new(), file: None, length: 0, recorded }
    }

    /// Opens the journal at `path`, to go on with it; makes a new one, with its folder, where there is none. With `fresh` what
    /// is there is thrown away.
    ///
    /// # Errors
    /// If what is there cannot be read, is no journal of this study, was begun with other settings, by another build or on another
    /// machine, or is being written by another process; or if the file cannot be made.
    pub fn open(path: &Path, header: Header, fresh: bool) -> Result<Self, JournalError> {
        let unwritable = |cause| JournalError::Write { path: path.into(), cause };
        if let Some(folder) = path.parent() {
            fs::create_dir_all(folder).map_err(unwritable)?;
        }
        if fs::metadata(path).is_ok_and(|there| !there.is_file()) {
            return Err(JournalError::NoFile(path.into()));
        }
        let mut file =
            OpenOptions::new().read(true).write(true).create(true).truncate(false).open(path).map_err(unwritable)?;
        file.try_lock().map_err(|error| match error {
            TryLockError::WouldBlock => JournalError::Busy(path.into()),
            TryLockError::Error(cause) => unwritable(cause),
        })?;

        let mut bytes = vec![];
        if !fresh {
            file.read_to_end(&mut bytes).map_err(|cause| JournalError::Read { path: path.into(), cause })?;
        }
        let whole = whole_lines(&bytes);
        let recorded = if whole.is_empty() {
            // The first line may have been torn; anything else is not ours to throw away.
            if !header.may_begin(&bytes) {
                return Err(JournalError::Foreign(path.into()));
            }
            Recorded { header, cases: vec![], keys: BTreeMap::new() }
        } else {
            Recorded::parse(path, whole, |there| header.admits(there, path))?
        };
        let mut journal = Self { path: path.into(), file: Some(file), length: whole.len() as u64, recorded };
        if journal.length == 0 {
            let line = serde_json::to_string(&journal.recorded.header).expect("a header has text keys");
            journal.write(&line)?;
            journal.sync_folder();
        } else if let Some(file) = &journal.file {
            file.set_len(journal.length).map_err(unwritable)?;
        }
        Ok(journal)
    }

    /// The case `key`, if it has been measured.
    pub fn get(&self, key: &str) -> Option<&C> {
        self.recorded.get(key)
    }

    /// Where its cases come from, also where this process has measured none of them.
    pub fn provenance(&self) -> &Provenance {
        &self.recorded.header.provenance
    }

    /// All cases, in the order in which they were measured.
    pub fn cases(&self) -> &[C] {
        &self.recorded.cases
    }

    /// Those of `keys` that are not yet measured.
    pub fn left<'a>(&self, keys: impl IntoIterator<Item = &'a str>) -> Vec<&'a str> {
        keys.into_iter().filter(|key| self.get(key).is_none()).collect()
    }

    /// Keeps a case: when this returns it is on the disk.
    ///
    /// # Errors
    /// If it cannot be written, which leaves the journal as it was.
    ///
    /// # Panics
    /// If there is a case with this key, or the case would not read back.
    pub fn append(&mut self, key: &str, case: C) -> Result<(), JournalError> {
        assert!(self.get(key).is_none(), "the case {key:?} is measured twice");
        let line = serde_json::to_string(&Line { key: key.into(), case: &case }).expect("a case has text keys");
        // Numbers that are infinite or none would be written as null, and make the journal unreadable.
        assert!(serde_json::from_str::<Line<C>>(&line).is_ok(), "the case {key:?} does not read back: {line}");
        self.write(&line)?;
        self.recorded.add(key.into(), case);
        Ok(())
    }

    /// Keeps at `path` what was kept in memory.
    ///
    /// # Errors
    /// As [`open`](Self::open) and [`append`](Self::append).
    pub fn keep(self, path: &Path) -> Result<(), JournalError> {
        let Recorded { header, cases, keys } = self.recorded;
        let mut kept = Self::open(path, header, true)?;
        let mut keys: Vec<(String, usize)> = keys.into_iter().collect();
        keys.sort_by_key(|(_, number)| *number);
        keys.iter().zip(cases).try_for_each(|((key, _), case)| kept.append(key, case))
    }

    /// What the journal of `study` holds, without opening it for writing; a line that is being written is passed over.
    ///
    /// # Errors
    /// If the file cannot be read, or is no journal of this study and form.
    pub fn read(path: &Path, study: &str) -> Result<Recorded<C>, JournalError> {
        let bytes = fs::read(path).map_err(|cause| JournalError::Read { path: path.into(), cause })?;
        match whole_lines(&bytes) {
            [] => Err(JournalError::Foreign(path.into())),
            whole => Recorded::parse(path, whole, |there| there.is_of(study, path)),
        }
    }

    /// Writes one line whole, or takes back what was written of it.
    fn write(&mut self, line: &str) -> Result<(), JournalError> {
        let Some(file) = &mut self.file else { return Ok(()) };
        let bytes = format!("{line}\n").into_bytes();
        let length = self.length;
        let mut write = || {
            file.seek(SeekFrom::Start(length))?;
            file.set_len(length)?;
            file.write_all(&bytes)?;
            file.sync_data()
        };
        write().map_err(|cause| {
            // If even this fails, what is left is a torn line, which the next run drops.
            let _ = file.set_len(length);
            JournalError::Write { path: self.path.clone(), cause }
        })?;
        self.length += bytes.len() as u64;
        Ok(())
    }

    /// Makes the name of a new file as lasting as its contents, where the system knows how.
    fn sync_folder(&self) {
        let folder = self.path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
        let _ = File::open(folder).and_then(|folder| folder.sync_all());
    }
}

impl<C> Recorded<C> {
    /// The case `key`.
    pub fn get(&self, key: &str) -> Option<&C> {
        self.keys.get(key).map(|&i| &self.cases[i])
    }

    /// The keys, in the order of their names.
    pub fn keys(&self) -> impl Iterator<Item = &str> {
        self.keys.keys().map(String::as_str)
    }

    fn add(&mut self, key: String, case: C) {
        self.keys.insert(key, self.cases.len());
        self.cases.push(case);
    }
}

impl<C: DeserializeOwned> Recorded<C> {
    /// Reads whole lines, the cases only once `admit` has seen the header.
    fn parse(
        path: &Path,
        bytes: &[u8],
        admit: impl FnOnce(&Header) -> Result<(), JournalError>,
    ) -> Result<Self, JournalError> {
        let damaged =
            |line: usize, problem: String| JournalError::Damaged { path: path.into(), line: line + 1, problem };
        let mut lines = bytes.split(|&byte| byte == b'\n').enumerate();
        let (_, first) = lines.next().expect("a split has a part");
        let header = serde_json::from_slice::<Header>(first).map_err(|error| {
            if Header::is_one(first) { damaged(0, plain(&error)) } else { JournalError::Foreign(path.into()) }
        })?;
        admit(&header)?;
        let mut recorded = Self { header, cases: vec![], keys: BTreeMap::new() };
        for (number, line) in lines.filter(|(_, line)| !line.is_empty()) {
            let Line { key, case } = serde_json::from_slice(line).map_err(|error| damaged(number, plain(&error)))?;
            if recorded.get(&key).is_some() {
                return Err(damaged(number, format!("the case {key:?} is there a second time")));
            }
            recorded.add(key, case);
        }
        Ok(recorded)
    }
}

/// `bytes` up to the last line end.
fn whole_lines(bytes: &[u8]) -> &[u8] {
    let end = bytes.iter().rposition(|&byte| byte == b'\n').map_or(0, |last| last + 1);
    &bytes[..end]
}

/// What is wrong, without the place in a line that nobody counts.
fn plain(error: &serde_json::Error) -> String {
    let text = error.to_string();
    text.split(" at line ").next().unwrap_or(&text).to_owned()
}
