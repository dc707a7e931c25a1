//! A case in a file of its own, written whole or not at all.

use std::fs;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};

use super::{Header, JournalError};
use crate::measure::{Provenance, checksum};
use crate::output::{OutputError, OutputFile};

/// Version of the form of cases.
pub const SCHEMA: u32 = 3;

/// A case with all that must be known of it.
#[derive(Clone, Debug, PartialEq)]
pub struct CaseFile<C> {
    pub path: PathBuf,
    pub header: Header,
    pub key: String,
    pub case: C,
}

/// The fields of its file.
#[derive(Serialize, Deserialize)]
struct Fields<C> {
    schema: u32,
    study: String,
    settings: Map<String, Value>,
    provenance: Provenance,
    key: String,
    case: C,
}

/// The name of the file of the case `key`, in small letters, digits and hyphens: another key has another name.
pub fn file_name(key: &str) -> String {
    let plain = |c: char| if c.is_ascii_alphanumeric() { c.to_ascii_lowercase() } else { '-' };
    let words: String = key.chars().map(plain).collect();
    let words: Vec<&str> = words.split('-').filter(|word| !word.is_empty()).collect();
    let name: String = words.join("-").chars().take(LONGEST).collect();
    format!("{}-{:08x}.json", name.trim_end_matches('-'), checksum(key.bytes().map(u64::from)) as u32)
}

/// Characters of a name before what tells it from others, at most.
const LONGEST: usize = 100;

/// Reads a case of a study from what its file has of it.
pub type Read<C> = fn(&Value) -> serde_json::Result<C>;

/// The text of the file of a case.
///
/// # Panics
/// If the case would not read back.
pub fn text<C: Serialize>(header: &Header, key: &str, case: &C, read: Read<C>) -> String {
    let Header { study, settings, provenance } = header.clone();
    let case = serde_json::to_value(case).expect("a case has text keys");
    // Numbers that are infinite or none become null, and would make the case unreadable.
    assert!(read(&case).is_ok(), "the case {key:?} does not read back: {case}");
    let fields = Fields { schema: SCHEMA, study, settings, provenance, key: key.into(), case };
    serde_json::to_string(&fields).expect("names are text") + "\n"
}

impl CaseFile<Value> {
    /// Reads the file `path`.
    ///
    /// # Errors
    /// If it cannot be read, is no case or one of another version.
    pub fn read(path: &Path) -> Result<Self, JournalError> {
        let bytes = fs::read(path).map_err(|cause| JournalError::Read { path: path.into(), cause })?;
        let value = serde_json::from_slice(&bytes).map_err(|cause| damaged(path, &cause))?;
        if is_case(&value) { Self::of(path, value) } else { Err(JournalError::Foreign(path.into())) }
    }

    /// Likewise, of a file that has been read and [is a case](is_case).
    ///
    /// # Errors
    /// If it is of another version.
    pub fn of(path: &Path, value: Value) -> Result<Self, JournalError> {
        let there = value.get("schema").and_then(Value::as_u64).unwrap_or(0) as u32;
        if there != SCHEMA {
            return Err(JournalError::Schema { path: path.into(), there, here: SCHEMA });
        }
        let fields = serde_json::from_value(value).map_err(|cause| damaged(path, &cause))?;
        let Fields { study, settings, provenance, key, case, .. } = fields;
        Ok(Self { path: path.into(), header: Header { study, settings, provenance }, key, case })
    }

    /// The same with a case of the study.
    ///
    /// # Errors
    /// If it is none.
    pub fn typed<C>(self, read: Read<C>) -> Result<CaseFile<C>, JournalError> {
        let case = self.read_case(read)?;
        let Self { path, header, key, .. } = self;
        Ok(CaseFile { path, header, key, case })
    }

    /// Its case, as one of the study.
    ///
    /// # Errors
    /// If it is none.
    pub fn read_case<C>(&self, read: Read<C>) -> Result<C, JournalError> {
        read(&self.case).map_err(|cause| damaged(&self.path, &cause))
    }
}

impl<C> CaseFile<C> {
    /// What the file `path` holds, if there is one: the case `key`, as a run with the header `here` would measure it.
    ///
    /// # Errors
    /// If it holds anything else.
    pub fn there(path: &Path, here: &Header, key: &str, read: Read<C>) -> Result<Option<Self>, JournalError> {
        if !path.exists() {
            return Ok(None);
        }
        let there = CaseFile::read(path)?;
        here.admits(&there.header, path)?;
        if there.key != key {
            return Err(JournalError::Key { path: path.into(), there: there.key, here: key.into() });
        }
        there.typed(read).map(Some)
    }
}

/// Whether this is a case, of whatever version and study.
pub fn is_case(value: &Value) -> bool {
    ["schema", "study", "settings", "provenance"].iter().all(|field| value.get(field).is_some())
}

/// The file `path` for a case, before that is measured; makes its folder.
///
/// # Errors
/// If the folder cannot be made or takes no file.
pub fn place(path: &Path) -> Result<OutputFile, JournalError> {
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty());
    folder.map_or(Ok(()), fs::create_dir_all).map_err(|cause| JournalError::Write { path: path.into(), cause })?;
    OutputFile::check(path).map_err(|error| unwritable(path, error))
}

/// Writes a case as a new file; tells whether there was none before.
///
/// # Errors
/// If the system refuses, or there is no room: nothing is there then.
pub fn write(file: &OutputFile, text: &str) -> Result<bool, JournalError> {
    file.write_new(text.as_bytes()).map_err(|error| unwritable(file.path(), error))
}

fn unwritable(path: &Path, error: OutputError) -> JournalError {
    match error {
        OutputError::Write { cause, .. } => JournalError::Write { path: path.into(), cause },
        other => JournalError::Place(other),
    }
}

/// What is wrong, without the place in a line that nobody counts.
fn damaged(path: &Path, cause: &serde_json::Error) -> JournalError {
    let text = cause.to_string();
    let problem = text.split(" at line ").next().unwrap_or(&text).to_owned();
    JournalError::Damaged { path: path.into(), problem }
}
