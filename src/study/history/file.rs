//! The file of a history: JSON lines, the oldest run first.

use std::fs::{self, File};
use std::io;
use std::path::{Path, PathBuf};

use super::Entry;
use crate::escaped::Escaped as _;
use crate::output::{OutputError, OutputFile};

/// Its name, in the folder of baselines.
pub const FILE: &str = "history.jsonl";

/// Why a history cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum HistoryError {
    #[error("cannot read {}: {cause}", path.escaped())]
    Read { path: PathBuf, cause: io::Error },
    #[error("line {line} of {} is no run that --save-baseline has kept ({cause}): remove that line, or the file to begin a new history", path.escaped())]
    Line { path: PathBuf, line: usize, cause: String },
    #[error(transparent)]
    Write(#[from] OutputError),
}

/// The runs in a file, the oldest first; none where there is no file.
///
/// # Errors
/// If it cannot be read, or a line is no run of this version.
pub fn read(path: &Path) -> Result<Vec<Entry>, HistoryError> {
    let text = match fs::read_to_string(path) {
        Ok(text) => text,
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(vec![]),
        Err(cause) => return Err(HistoryError::Read { path: path.into(), cause }),
    };
    let entry = |(number, line): (usize, &str)| {
        let error = |cause: String| HistoryError::Line { path: path.into(), line: number + 1, cause };
        let entry: Entry = serde_json::from_str(line).map_err(|cause| error(cause.to_string()))?;
        if entry.schema != Entry::SCHEMA {
            return Err(error(format!("its form is version {}, not {}", entry.schema, Entry::SCHEMA)));
        }
        Ok(entry)
    };
    text.lines().enumerate().filter(|(_, line)| !line.trim().is_empty()).map(entry).collect()
}

/// Adds a run, in the place of an older one of the same commit and machine: a commit that is measured again is no newer
/// for it. The file is written anew, whole or not at all.
///
/// # Errors
/// As [`read`], and if the file cannot be written.
pub fn add(path: &Path, entry: Entry) -> Result<(), HistoryError> {
    let file = OutputFile::check(path)?;
    // Of two machines that add at once one waits: it would write away what the other has added. Where files cannot be
    // locked, as on some network file systems, nobody waits.
    let lock = File::create(path.with_extension("lock"));
    if let Ok(lock) = &lock {
        let _ = lock.lock();
    }
    let mut entries = read(path)?;
    match entries.iter_mut().find(|older| entry.replaces(older)) {
        Some(older) => *older = entry,
        None => entries.push(entry),
    }
    let line = |entry: &Entry| serde_json::to_string(entry).expect("a run has text keys") + "\n";
    file.write(entries.iter().map(line).collect::<String>().as_bytes())?;
    Ok(())
}
