//! Runs this program again in a separate process, for a limited time.

use std::ffi::OsStr;
use std::io::{self, Read};
use std::process::{Command, Output, Stdio};
use std::thread;
use std::time::Duration;

use super::{process_group, program};

/// This program with other arguments.
pub fn same_program(args: impl IntoIterator<Item: AsRef<OsStr>>) -> Command {
    let mut command = Command::new(program::executable());
    command.args(args);
    command
}

/// The output and exit status of a program; `None` if it took longer than `limit`: then it was killed, together with
/// all programs that it had started.
///
/// # Errors
/// If it cannot be started or waited for.
pub fn output_within(command: &mut Command, limit: Duration) -> io::Result<Option<Output>> {
    process_group::set_apart(command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped()));
    let mut child = command.spawn()?;

    // Empty both pipes at once: a full one would stop the program.
    let (mut out, mut err) = (child.stdout.take().expect("piped"), child.stderr.take().expect("piped"));
    thread::scope(|scope| {
        let (out, err) = (scope.spawn(move || drain(&mut out)), scope.spawn(move || drain(&mut err)));
        let in_time = process_group::ends_within(&mut child, limit);
        process_group::end(&mut child);
        let status = child.wait()?;
        let (stdout, stderr) = (out.join().expect("reads only")?, err.join().expect("reads only")?);
        Ok(in_time.then_some(Output { status, stdout, stderr }))
    })
}

fn drain(pipe: &mut dyn Read) -> io::Result<Vec<u8>> {
    let mut bytes = vec![];
    pipe.read_to_end(&mut bytes)?;
    Ok(bytes)
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;

    fn shell(script: &str, limit: Duration) -> Option<Output> {
        output_within(Command::new("/bin/sh").args(["-c", script]), limit).unwrap()
    }

    #[test]
    fn a_full_pipe_stops_no_program() {
        let output = shell("yes | head -c 1000000 >&2; echo done; exit 101", Duration::from_secs(60)).unwrap();
        assert_eq!((output.status.code(), output.stderr.len()), (Some(101), 1_000_000));
        assert_eq!(output.stdout, b"done\n");
    }

    /// The pipe is open until the last of them ends.
    #[test]
    #[cfg(target_os = "linux")]
    fn what_takes_too_long_is_killed_with_all_that_it_started() {
        let start = std::time::Instant::now();
        assert_eq!(shell("sleep 600 & sleep 600", Duration::from_millis(300)), None);
        assert!(start.elapsed() < Duration::from_secs(60), "{:?}", start.elapsed());
    }
}
