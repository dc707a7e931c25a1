//! Ends a program and the descendants of the program.
//!
//! On Linux, each program leads a separate process group, so Ctrl-C does not reach the program. On other systems,
//! Ctrl-C reaches the program. On other systems, the descendants are not killed.

use std::io::{self, Read};
#[cfg(target_os = "linux")]
use std::os::unix::process::CommandExt;
use std::process::{Child, Command, Output, Stdio};
use std::thread;
use std::time::{Duration, Instant};

#[cfg(target_os = "linux")]
use nix::{
    errno::Errno,
    sys::signal::{SigSet, Signal, kill, killpg},
    sys::wait::{Id, WaitPidFlag, WaitStatus, waitid},
    unistd::Pid,
};

#[cfg(target_os = "linux")]
pub fn lead_process_group(command: &mut Command) {
    command.process_group(0);
    // Without `pre_exec`, the program would inherit the blocked signals of this thread.
    // SAFETY: between fork and exec, only async-signal-safe calls are sound. The closure calls only `sigemptyset`
    // and `pthread_sigmask`. The conversion of the error does not allocate.
    unsafe { command.pre_exec(|| Ok(SigSet::empty().thread_set_mask()?)) };
}

#[cfg(not(target_os = "linux"))]
pub fn lead_process_group(_: &mut Command) {}

/// The caller must still reap the child.
#[cfg(target_os = "linux")]
fn has_ended(child: &mut Child) -> bool {
    state(child) != Ok(WaitStatus::StillAlive)
}

#[cfg(not(target_os = "linux"))]
fn has_ended(child: &mut Child) -> bool {
    !matches!(child.try_wait(), Ok(None))
}

const PAUSE: Duration = Duration::from_millis(1);

/// The caller must still reap the child.
pub fn ends_within(child: &mut Child, limit: Duration) -> bool {
    let start = Instant::now();
    while !has_ended(child) {
        if start.elapsed() >= limit {
            return false;
        }
        thread::sleep(PAUSE);
    }
    true
}

/// Returns `None` if the program does not end within `limit`. The function calls [`end`] in every case.
///
/// # Errors
/// If the program cannot be started, the wait for the program fails, or the output cannot be read.
pub fn output_within(command: &mut Command, limit: Duration) -> io::Result<Option<Output>> {
    lead_process_group(command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped()));
    let mut child = command.spawn()?;

    // A full pipe would block the program, so both pipes are read concurrently.
    let (mut out, mut err) = (child.stdout.take().expect("piped"), child.stderr.take().expect("piped"));
    thread::scope(|scope| {
        let (out, err) = (scope.spawn(move || drain(&mut out)), scope.spawn(move || drain(&mut err)));
        let in_time = ends_within(&mut child, limit);
        end(&mut child);
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

/// On Linux, the system kills this process when the parent thread ends.
pub fn end_with_parent() {
    #[cfg(target_os = "linux")]
    let _ = nix::sys::prctl::set_pdeathsig(Signal::SIGKILL);
}

/// Kills a program and the descendants of the program. [`lead_process_group`] must have prepared the command. The call
/// has no effect on a reaped child.
pub fn end(child: &mut Child) {
    // The system does not reuse the process id of a child before the child is reaped.
    #[cfg(target_os = "linux")]
    if state(child) != Err(Errno::ECHILD) {
        end_group(child.id());
    }
    let _ = child.kill();
}

/// Kills the descendants of `process`. A descendant that leads a process group is killed with the group.
#[cfg(target_os = "linux")]
pub fn end_started_by(process: u32) {
    let threads = std::fs::read_dir(format!("/proc/{process}/task")).into_iter().flatten().flatten();
    let children: String =
        threads.filter_map(|thread| std::fs::read_to_string(thread.path().join("children")).ok()).collect();
    children.split_whitespace().filter_map(|number| number.parse::<u32>().ok()).for_each(end_group);
}

#[cfg(target_os = "linux")]
fn end_group(first: u32) {
    end_started_by(first);
    let first = Pid::from_raw(first as i32);
    let _ = killpg(first, Signal::SIGKILL).or_else(|_| kill(first, Signal::SIGKILL));
}

/// The error is `ECHILD` if the child has already been reaped.
#[cfg(target_os = "linux")]
fn state(child: &Child) -> nix::Result<WaitStatus> {
    let looks = WaitPidFlag::WEXITED | WaitPidFlag::WNOHANG | WaitPidFlag::WNOWAIT;
    waitid(Id::Pid(Pid::from_raw(child.id() as i32)), looks)
}

#[cfg(all(test, target_os = "linux"))]
mod tests {
    use std::io::{BufRead, BufReader};
    use std::os::unix::process::ExitStatusExt;

    use super::*;

    #[test]
    fn signals_that_are_blocked_here_end_a_program() {
        let caught = SigSet::from_iter([Signal::SIGUSR1]);
        let start = move || {
            let mut command = Command::new("sleep");
            lead_process_group(command.arg("20"));
            caught.thread_block().unwrap();
            command.spawn().unwrap()
        };
        let mut program = std::thread::spawn(start).join().unwrap();
        kill(Pid::from_raw(program.id() as i32), Signal::SIGUSR1).unwrap();
        let status = program.wait().unwrap();
        assert_eq!(status.signal(), Some(Signal::SIGUSR1 as i32));
    }

    #[test]
    fn a_program_that_leads_no_group_is_ended_as_well() {
        let mut command = Command::new("sh");
        command.args(["-c", "sleep 20 & echo; wait $!"]).stdout(Stdio::piped()).stderr(Stdio::null());
        let mut shell = command.spawn().unwrap();
        let mut line = String::new();
        BufReader::new(shell.stdout.take().unwrap()).read_line(&mut line).unwrap();
        end_started_by(shell.id());
        assert_eq!(shell.wait().unwrap().code(), Some(128 + Signal::SIGKILL as i32), "the shell reports the signal");
    }

    fn shell(script: &str, limit: Duration) -> Option<Output> {
        output_within(Command::new("/bin/sh").args(["-c", script]), limit).unwrap()
    }

    #[test]
    fn a_full_pipe_stops_no_program() {
        let output = shell("yes | head -c 1000000 >&2; echo done; exit 101", Duration::from_secs(60)).unwrap();
        assert_eq!((output.status.code(), output.stderr.len()), (Some(101), 1_000_000));
        assert_eq!(output.stdout, b"done\n");
    }

    /// Both `sleep` processes keep the pipes open.
    #[test]
    fn what_takes_too_long_is_killed_with_all_that_it_started() {
        let start = Instant::now();
        assert_eq!(shell("sleep 600 & sleep 600", Duration::from_millis(300)), None);
        assert!(start.elapsed() < Duration::from_secs(60), "{:?}", start.elapsed());
    }
}
