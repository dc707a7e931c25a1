//! Standard output and standard error.
//!
//! A reader that has gone away, as `head` does, has what it wanted: a run goes on without it to its verdict. Anything else that
//! keeps a result from standard output is an error, told at the end, and leaves the verdict as it is.

use std::fmt::Display;
use std::io::{self, Write};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError};

use crate::escaped::Escaped as _;

/// The file name that stands for standard output.
pub const STDOUT: &str = "-";

/// Whether a result goes to standard output: then nothing else may.
static TO_STDOUT: AtomicBool = AtomicBool::new(false);

/// Why something could not be written to standard output.
static FAILURE: Mutex<Option<io::Error>> = Mutex::new(None);

/// Whether a result was requested as [`STDOUT`]: messages for people go to standard error then.
pub fn stdout_is_taken() -> bool {
    TO_STDOUT.load(Ordering::Relaxed)
}

pub(super) fn take_stdout() {
    TO_STDOUT.store(true, Ordering::Relaxed);
}

/// Writes to standard output; [`take_failure`] tells whether that failed.
pub(crate) fn print(bytes: &[u8]) {
    let mut out = io::stdout().lock();
    note(out.write_all(bytes).and_then(|()| out.flush()));
}

pub(crate) fn note(written: io::Result<()>) {
    if let Err(cause) = unless_gone(written) {
        FAILURE.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert(cause);
    }
}

/// Why standard output has not got all that was written, asked once: nothing if it has, or its reader has gone away.
pub(crate) fn take_failure() -> Option<io::Error> {
    FAILURE.lock().unwrap_or_else(PoisonError::into_inner).take()
}

/// A reader that has gone away is no error.
pub(super) fn unless_gone(written: io::Result<()>) -> io::Result<()> {
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
