//! One run at a time measures into a journal.

use std::fs::{File, TryLockError};
use std::path::Path;

/// What a run holds of the folder that it measures into. The system lets go of it when the process ends, however that happens, and nothing
/// is left in the folder.
#[derive(Debug)]
pub struct Lock {
    _folder: Option<File>,
}

impl Lock {
    /// That of `folder`, unless another run holds it. Where folders cannot be locked, as on Windows and on many network file systems, nobody
    /// is kept out.
    pub fn take(folder: &Path) -> Option<Self> {
        let folder = File::open(folder).ok();
        let is_taken = folder.as_ref().is_some_and(|folder| matches!(folder.try_lock(), Err(TryLockError::WouldBlock)));
        (!is_taken).then_some(Self { _folder: folder })
    }
}
