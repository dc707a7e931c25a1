//! Files and folders written whole or not at all; standard output, whose reader may go away.
//!
//! Contents are first written beside their place under a temporary name and then moved there: a reader never sees half
//! of them, and what was there before stays when something fails.

mod file;
mod folder;
mod standard;

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use tempfile::Builder;

use crate::escaped::Escaped as _;

pub use file::OutputFile;
pub use folder::OutputFolder;
pub use standard::{STDOUT, stdout_is_taken};
pub(crate) use standard::{note, print, take_failure, tell, tell_error};

/// Why a file or a folder cannot be written.
#[derive(Debug, thiserror::Error)]
pub enum OutputError {
    #[error("cannot write {}: it is a directory: name a file in it", .0.escaped())]
    Directory(PathBuf),
    #[error("{} is a file: name a folder that does not exist yet", .0.escaped())]
    File(PathBuf),
    #[error("cannot write {}: it is one of the files to read: name another one", .0.escaped())]
    Input(PathBuf),
    #[error("cannot replace {}: {}, one of the files to read, is in it: name another folder",
        path.escaped(), input.escaped())]
    InputInside { path: PathBuf, input: PathBuf },
    #[error("{} contains {other}, which sahara has not written there: name another folder, or empty it",
        path.escaped())]
    Foreign { path: PathBuf, other: String },
    #[error("cannot write two results to {}: name another file for one of them", .0.escaped())]
    Same(PathBuf),
    #[error("cannot write two results to standard output: name a file for one of them")]
    Twice,
    #[error("cannot write {}: {cause}: choose a place that exists, may be written and has room", path.escaped())]
    Write { path: PathBuf, cause: io::Error },
}

impl OutputError {
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

/// Makes temporary files and folders; on Unix with the permissions `mode`, less what the process's umask takes.
fn temporary(#[cfg_attr(not(unix), expect(unused_variables))] mode: u32) -> Builder<'static, 'static> {
    let mut builder = Builder::new();
    builder.prefix(".sahara-").suffix(".part");
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        builder.permissions(fs::Permissions::from_mode(mode));
    }
    builder
}
