//! A program that answers lines with lines.

use std::io::{BufRead, BufReader, Read, Write};
use std::process::{Child, ChildStdin, Command, ExitStatus, Stdio};
use std::sync::mpsc::{Receiver, RecvTimeoutError, sync_channel};
use std::thread;
use std::time::{Duration, Instant};

use crate::measure::{on_all_cores, process_group};

/// A program that is asked line by line, and may take so long for each answer.
pub(super) struct Conversation {
    child: Child,
    /// Nothing once it was told that there is no more.
    input: Option<ChildStdin>,
    lines: Receiver<Vec<u8>>,
    limit: Duration,
}

/// A line, and how long it took, as seen from outside.
pub(super) struct Answer {
    pub text: String,
    pub ns: u64,
}

/// The longest answer; what is longer is cut.
const LONGEST: u64 = 4096;

/// What a program may take to end.
const FAREWELL: Duration = Duration::from_millis(500);

impl Conversation {
    /// Starts `words`, the program first. On several threads it may use all cores that this process may.
    pub fn start(words: &[String], threads: usize, limit: Duration) -> Result<Self, String> {
        let mut command = Command::new(&words[0]);
        command.args(&words[1..]).stdin(Stdio::piped()).stdout(Stdio::piped());
        process_group::set_apart(&mut command);
        let child = if threads > 1 { on_all_cores(|| command.spawn()) } else { command.spawn() };
        let mut child = child.map_err(|cause| format!("it cannot be started: {cause}"))?;
        let (input, output) = (child.stdin.take(), child.stdout.take().expect("it has an output"));
        // More than was asked for stays in the pipe and stops the program: it costs no memory, and no time of others.
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

    /// The answer to a line.
    ///
    /// # Errors
    /// A clause, if the program has ended, does not answer in time, answers before it is asked or says what is wrong. It is
    /// ended then.
    pub fn ask(&mut self, request: &str) -> Result<Answer, String> {
        let answer = self.answer(request);
        if answer.is_err() {
            self.end(Duration::ZERO);
        }
        answer
    }

    fn answer(&mut self, request: &str) -> Result<Answer, String> {
        if let Ok(line) = self.lines.try_recv() {
            return Err(format!("it says {:?} before it is asked {request:?}", text(&line)));
        }
        let start = Instant::now();
        // Of a program that has ended the next line is missing.
        if let Some(input) = &mut self.input {
            let _ = writeln!(input, "{request}");
        }
        let line = match self.lines.recv_timeout(self.limit) {
            Ok(line) => line,
            Err(RecvTimeoutError::Timeout) => {
                let limit = self.limit.as_secs_f64();
                return Err(format!("it does not answer {request:?} within {limit} s: --runner-limit gives it longer"));
            }
            Err(RecvTimeoutError::Disconnected) => {
                let how = self.end(FAREWELL).map_or("it closed its output".into(), |status| status.to_string());
                return Err(format!("it ends instead of answering {request:?} ({how})"));
            }
        };
        let ns = start.elapsed().as_nanos() as u64;
        let text = text(&line);
        match text.strip_prefix("error ") {
            Some(sentence) => Err(format!("it says: {sentence}")),
            None => Ok(Answer { text, ns }),
        }
    }

    /// Tells it that there is no more, waits so long, and ends it with all that it has started; how it ended, if it did
    /// of itself.
    fn end(&mut self, patience: Duration) -> Option<ExitStatus> {
        self.input = None;
        let has_ended = process_group::ends_within(&mut self.child, patience);
        process_group::end(&mut self.child);
        self.child.wait().ok().filter(|_| has_ended)
    }
}

impl Drop for Conversation {
    fn drop(&mut self) {
        self.end(FAREWELL);
    }
}

/// A line without its end, and without what would garble a terminal.
fn text(line: &[u8]) -> String {
    let text = String::from_utf8_lossy(line);
    text.trim_end_matches(['\r', '\n']).chars().map(|c| if c.is_control() { '\u{fffd}' } else { c }).collect()
}

/// Said of an answer that does not have the form that it should have.
pub(super) fn misfit(request: &str, answer: &str, form: &str) -> String {
    format!("it answers {answer:?} to {request:?}, not {form:?}: its messages belong on standard error")
}

/// Nanoseconds from seconds as a runner says them: a number that is finite and not negative.
pub(super) fn nanoseconds(seconds: &str) -> Option<u64> {
    let seconds: f64 = seconds.parse().ok()?;
    (0.0..1e9).contains(&seconds).then_some((seconds * 1e9) as u64)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn shell(script: &str) -> Conversation {
        let words = ["sh", "-c", script].map(String::from);
        Conversation::start(&words, 1, Duration::from_secs(10)).unwrap()
    }

    #[test]
    fn a_program_that_says_more_than_it_is_asked_is_stopped() {
        let mut conversation = shell("head -c 1000000 /dev/zero");
        assert_eq!(conversation.end(FAREWELL), None, "it has said all of it");
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn what_a_program_has_started_ends_with_it() {
        for (script, ends_of_itself) in [("wait", false), ("exit", true)] {
            let mut conversation = shell(&format!("read -r line; sleep 60 & echo started; {script}"));
            assert_eq!(conversation.ask("start").unwrap().text, "started");
            let patience = if ends_of_itself { Duration::from_secs(10) } else { FAREWELL };
            assert_eq!(conversation.end(patience).is_some(), ends_of_itself, "{script}");
            // Its output is closed once nobody has it.
            let next = conversation.lines.recv_timeout(Duration::from_secs(10));
            assert_eq!(next, Err(RecvTimeoutError::Disconnected), "{script}");
        }
    }
}
