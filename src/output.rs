//! Files and folders written whole or not at all.
//!
//! Contents are first written beside their place under a temporary name and then moved there: a reader never sees half
//! of them, and what was there before stays when something fails.

mod file;
mod folder;

use std::fmt::Display;
use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};

use tempfile::Builder;

pub use file::{OutputFile, STDOUT};
pub use folder::OutputFolder;

/// Whether a result goes to standard output: then nothing else may.
static TO_STDOUT: AtomicBool = AtomicBool::new(false);

/// Whether a result was requested as [`STDOUT`]: messages for people go to standard error then.
pub fn stdout_is_taken() -> bool {
    TO_STDOUT.load(Ordering::Relaxed)
}

/// Why a file or a folder cannot be written.
#[derive(Debug, thiserror::Error)]
pub enum OutputError {
    #[error("cannot write {}: it is a directory: name a file in it", .0.display())]
    Directory(PathBuf),
    #[error("{} is a file: name a folder that does not exist yet", .0.display())]
    File(PathBuf),
    #[error("cannot write {}: it is one of the files to read: name another one", .0.display())]
    Input(PathBuf),
    #[error("cannot replace {}: {}, one of the files to read, is in it: name another folder",
        path.display(), input.display())]
    InputInside { path: PathBuf, input: PathBuf },
    #[error("{} contains {other}, which sahara has not written there: name another folder, or empty it",
        path.display())]
    Foreign { path: PathBuf, other: String },
    #[error("cannot write two results to {}: name another file for one of them", .0.display())]
    Same(PathBuf),
    #[error("cannot write two results to standard output: name a file for one of them")]
    Twice,
    #[error("cannot write {}: {cause}: choose a place that exists, may be written and has room", path.display())]
    Write { path: PathBuf, cause: io::Error },
}

impl OutputError {
    /// A failed write of `path`. Of an error of tempfile, which names a temporary path, the kind is kept.
    fn write(path: &Path, error: io::Error) -> Self {
        let cause = if error.get_ref().is_some() { error.kind().into() } else { error };
        Self::Write { path: path.into(), cause }
    }
}

/// What `path` leads to where it is a link, otherwise `path`.
fn target(path: &Path) -> PathBuf {
    path.canonicalize().unwrap_or_else(|_| path.into())
}

/// The folder that `path` is in.
fn folder_of(path: &Path) -> &Path {
    path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."))
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

/// Writes a line to standard error; a closed pipe or a full disk ends no run.
pub(crate) fn tell(line: impl Display) {
    let _ = writeln!(io::stderr(), "{line}");
}
