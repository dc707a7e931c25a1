//! A program that replies to each line of input with a line of output.

use std::io::{BufRead, BufReader, Read, Write};
use std::process::{Child, ChildStdin, Command, ExitStatus, Stdio};
use std::sync::mpsc::{Receiver, RecvTimeoutError, sync_channel};
use std::thread;
use std::time::{Duration, Instant};

use crate::measure::{on_all_cores, process_group};

pub(super) struct Session {
    child: Child,
    /// `None` after the input was closed.
    input: Option<ChildStdin>,
    lines: Receiver<Vec<u8>>,
    limit: Duration,
}

pub(super) struct Reply {
    pub text: String,
    pub ns: u64,
}

/// The maximum length of a reply in bytes. The remainder of a longer line counts as output without a request.
const LONGEST: u64 = 4096;

/// The maximum wait for the end of a program after its input was closed.
const GRACE_PERIOD: Duration = Duration::from_millis(500);

impl Session {
    /// A program with several threads is not bound to the cores of the calling thread.
    pub fn start(words: &[String], threads: usize, limit: Duration) -> Result<Self, String> {
        let mut command = Command::new(&words[0]);
        command.args(&words[1..]).stdin(Stdio::piped()).stdout(Stdio::piped());
        process_group::lead_process_group(&mut command);
        let child = if threads > 1 { on_all_cores(|| command.spawn()) } else { command.spawn() };
        let mut child = child.map_err(|cause| format!("the program {:?} cannot be started: {cause}", words[0]))?;
        let (input, output) = (child.stdin.take(), child.stdout.take().expect("its output is a pipe"));
        // The channel holds one line. Further output without a request fills the pipe until the program blocks.
        let (sender, lines) = sync_channel(1);
        thread::spawn(move || {
            let mut output = BufReader::new(output);
            loop {
                let mut line = vec![];
                let read = output.by_ref().take(LONGEST).read_until(b'\n', &mut line);
                if !matches!(read, Ok(1..)) || sender.send(line).is_err() {
                    return;
                }
            }
        });
        Ok(Self { child, input, lines, limit })
    }

    /// Sends a line and returns the reply. Any error kills the program. The error is a clause.
    pub fn request(&mut self, request: &str) -> Result<Reply, String> {
        let reply = self.exchange(request);
        if reply.is_err() {
            self.end(Duration::ZERO);
        }
        reply
    }

    fn exchange(&mut self, request: &str) -> Result<Reply, String> {
        if let Ok(line) = self.lines.try_recv() {
            let advice = "print only replies to standard output";
            return Err(format!("it printed {:?} before the request {request:?}: {advice}", text(&line)));
        }
        let start = Instant::now();
        // The write may fail if the program has ended. The missing reply is reported below.
        if let Some(input) = &mut self.input {
            let _ = writeln!(input, "{request}");
        }
        let line = match self.lines.recv_timeout(self.limit) {
            Ok(line) => line,
            Err(RecvTimeoutError::Timeout) => {
                let limit = self.limit.as_secs_f64();
                return Err(format!("it does not reply to {request:?} within {limit} s: raise --runner-limit"));
            }
            Err(RecvTimeoutError::Disconnected) => {
                let how = self.end(GRACE_PERIOD).map_or("it closed its output".into(), |status| status.to_string());
                return Err(format!("it ended instead of replying to {request:?} ({how})"));
            }
        };
        let ns = start.elapsed().as_nanos() as u64;
        let text = text(&line);
        match text.strip_prefix("error ") {
            Some(sentence) => Err(format!("it reports the error: {sentence}")),
            None => Ok(Reply { text, ns }),
        }
    }

    /// Closes the input, waits up to `patience`, then kills the program and its descendants. Returns the exit status if
    /// the program ended within `patience`.
    fn end(&mut self, patience: Duration) -> Option<ExitStatus> {
        self.input = None;
        let has_ended = process_group::ends_within(&mut self.child, patience);
        process_group::end(&mut self.child);
        self.child.wait().ok().filter(|_| has_ended)
    }
}

impl Drop for Session {
    fn drop(&mut self) {
        self.end(GRACE_PERIOD);
    }
}

/// Replaces control characters, which would garble a terminal.
fn text(line: &[u8]) -> String {
    let text = String::from_utf8_lossy(line);
    text.trim_end_matches(['\r', '\n']).chars().map(|c| if c.is_control() { '\u{fffd}' } else { c }).collect()
}

/// An unexpected first word suggests that the reply is a message to the user.
pub(super) fn unexpected(request: &str, reply: &str, form: &str) -> String {
    let word = |line: &str| line.split(' ').next().map(String::from);
    let advice = if word(reply) == word(form) { "" } else { ": write messages to standard error" };
    format!("it replies {reply:?} to {request:?}, not {form:?}{advice}")
}

/// Nanoseconds from seconds. `None` outside [0, 1e9) seconds.
pub(super) fn nanoseconds(seconds: &str) -> Option<u64> {
    let seconds: f64 = seconds.parse().ok()?;
    (0.0..1e9).contains(&seconds).then_some((seconds * 1e9) as u64)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn shell(script: &str) -> Session {
        let words = ["sh", "-c", script].map(String::from);
        Session::start(&words, 1, Duration::from_secs(10)).unwrap()
    }

    #[test]
    fn a_program_that_writes_without_a_request_is_blocked() {
        let mut session = shell("head -c 1000000 /dev/zero");
        assert_eq!(session.end(GRACE_PERIOD), None, "it has written all of it");
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn programs_that_a_program_has_started_end_with_it() {
        for (script, ends_of_itself) in [("wait", false), ("exit", true)] {
            let mut session = shell(&format!("read -r line; sleep 60 & echo started; {script}"));
            assert_eq!(session.request("start").unwrap().text, "started");
            let patience = if ends_of_itself { Duration::from_secs(10) } else { GRACE_PERIOD };
            assert_eq!(session.end(patience).is_some(), ends_of_itself, "{script}");
            // The output ends when no process has it open.
            let next = session.lines.recv_timeout(Duration::from_secs(10));
            assert_eq!(next, Err(RecvTimeoutError::Disconnected), "{script}");
        }
    }
}
