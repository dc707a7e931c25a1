//! Files and folders written whole or not at all; standard output, whose reader may go away.
//!
//! Contents are first written beside their place under a temporary name and then moved there: a reader never sees half
//! of them, and what was there before stays when something fails.

mod file;
mod folder;
mod standard;

use std::io;
use std::path::{Path, PathBuf};

use tempfile::{Builder, NamedTempFile};

use crate::escaped::Escaped as _;

pub use file::OutputFile;
pub use folder::OutputFolder;
pub use standard::{STDOUT, stdout_is_taken};
pub(crate) use standard::{note, print, take_failure, tell, tell_error};

/// Why a file or a folder cannot be written.
#[derive(Debug, thiserror::Error)]
pub enum OutputError {
    #[error("cannot write {}: {problem}", path.escaped())]
    Place { path: PathBuf, problem: String },
    #[error("cannot write {}: {cause}: choose an existing, writable folder with free space", path.escaped())]
    Write { path: PathBuf, cause: io::Error },
}

impl OutputError {
    fn place(path: &Path, problem: impl Into<String>) -> Self {
        Self::Place { path: path.into(), problem: problem.into() }
    }

    /// A failed write of `path`. Of an error of tempfile, which names a temporary path, the kind is kept.
    fn write(path: &Path, error: io::Error) -> Self {
        let cause = if error.get_ref().is_some() { error.kind().into() } else { error };
        Self::Write { path: path.into(), cause }
    }
}

/// The one path of what is at `path` or will be there, with links followed.
fn resolved(path: &Path) -> io::Result<PathBuf> {
    path.canonicalize().or_else(|missing| {
        let (Some(folder), Some(name)) = (path.parent(), path.file_name()) else { return Err(missing) };
        Ok(Path::new(".").join(folder).canonicalize()?.join(name))
    })
}

/// The folder of a path that is [`resolved`].
fn folder_of(path: &Path) -> &Path {
    path.parent().unwrap_or(path)
}

/// A new file beside `path`, a path with a folder; it is removed when it is dropped.
pub(crate) fn temporary_file(path: &Path) -> io::Result<NamedTempFile> {
    temporary(0o666).tempfile_in(folder_of(path))
}

/// Makes temporary files and folders; on Unix with the permissions `mode`, less what the process's umask takes.
fn temporary(#[cfg_attr(not(unix), expect(unused_variables))] mode: u32) -> Builder<'static, 'static> {
    let mut builder = Builder::new();
    builder.prefix(".sahara-");
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(mode));
    builder
}
