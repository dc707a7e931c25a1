//! Files and folders written whole or not at all; standard output, whose reader may go away.
//!
//! Contents are first written beside their place under a temporary name and then moved there: a reader never sees half
//! of them, and what was there before stays when something fails.
//!
//! A reader of standard output that has gone away, as `head` does, has what it wanted: a run goes on without it to its
//! verdict. Anything else that keeps a result from standard output is told at the end, and leaves the verdict as it is.

mod file;
mod folder;

use std::fmt::Display;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::OnceLock;
use std::sync::atomic::{AtomicBool, Ordering};

use tempfile::{Builder, NamedTempFile};

use crate::escaped::Escaped as _;

pub use file::OutputFile;
pub use folder::OutputFolder;

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

/// The file name that stands for standard output.
pub const STDOUT: &str = "-";

/// Whether a result goes to standard output: then nothing else may.
static TO_STDOUT: AtomicBool = AtomicBool::new(false);

/// Why something could not be written to standard output.
static FAILURE: OnceLock<io::Error> = OnceLock::new();

/// Whether a result was requested as [`STDOUT`]: messages for people go to standard error then.
pub fn stdout_is_taken() -> bool {
    TO_STDOUT.load(Ordering::Relaxed)
}

/// Writes to standard output; [`failure`] tells whether that failed.
pub(crate) fn print(bytes: &[u8]) {
    let mut out = io::stdout().lock();
    note(out.write_all(bytes).and_then(|()| out.flush()));
}

pub(crate) fn note(written: io::Result<()>) {
    if let Err(cause) = unless_gone(written) {
        FAILURE.get_or_init(|| cause);
    }
}

/// Why standard output has not got all that was written: nothing if it has, or its reader has gone away.
pub(crate) fn failure() -> Option<&'static io::Error> {
    FAILURE.get()
}

/// A reader that has gone away is no error.
fn unless_gone(written: io::Result<()>) -> io::Result<()> {
    match written {
        Err(cause) if cause.kind() == io::ErrorKind::BrokenPipe => Ok(()),
        written => written,
    }
}

/// Writes to standard error what went wrong, in one line whatever the files hold that it is about.
pub(crate) fn tell_error(error: impl Display) {
    tell(format_args!("error: {}", error.to_string().escaped()));
}

/// Writes a line to standard error; a reader that has gone away, or a full disk, ends no run.
pub(crate) fn tell(line: impl Display) {
    let _ = writeln!(io::stderr(), "{line}");
}
