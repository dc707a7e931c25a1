//! Which program a runner is.

use std::path::Path;
use std::time::Duration;

use super::conversation::{Conversation, misfit};
use crate::accel::Capabilities;
use crate::measure::program::file_id;

/// A program that speaks the protocol, and how long it may take for an answer.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Program {
    command: String,
    /// The command, split as a shell does.
    words: Vec<String>,
    limit: Duration,
}

impl Program {
    /// Starts the program once, to see that it is one.
    ///
    /// # Errors
    /// A sentence, if the command is none, cannot be started or does not speak the protocol.
    pub fn new(command: &str, limit: Duration) -> Result<Self, String> {
        let words = shlex::split(command).filter(|words| !words.is_empty());
        let words = words.ok_or("a runner is a program and its arguments, in quotes where they hold spaces")?;
        let program = Self { command: command.into(), words, limit };
        program.start(1).map(|_| program)
    }

    /// As it was typed.
    pub fn command(&self) -> &str {
        &self.command
    }

    /// The name of the program without its folder, and the arguments.
    pub fn name(&self) -> String {
        let file = Path::new(&self.words[0]).file_name().unwrap_or_default().to_string_lossy().into_owned();
        [&[file], &self.words[1..]].concat().join(" ")
    }

    /// The first digits of the SHA-256 of its file: another build is another program. Of a program on the search path those of the first
    /// file among its arguments, which is the script of an interpreter; nothing where there is none.
    pub fn build_id(&self) -> Option<String> {
        let file = self.words.iter().map(Path::new).find(|word| word.is_file());
        file.and_then(|file| file_id(file).ok())
    }

    /// Starts it, and asks what it can be asked.
    pub(super) fn start(&self, threads: usize) -> Result<(Conversation, Capabilities), String> {
        let mut conversation = Conversation::start(&self.words, threads, self.limit)?;
        let request = format!("sahara {VERSION} {threads}");
        let answer = conversation.ask(&request)?.text;
        match answer.strip_prefix(&format!("runner {VERSION} ")) {
            Some("closest any") => Ok((conversation, Capabilities::ALL)),
            Some("closest") => Ok((conversation, Capabilities { any_hit: false, ..Capabilities::ALL })),
            _ => Err(misfit(&request, &answer, "runner 1 closest any")),
        }
    }
}

/// Version of the protocol.
const VERSION: u32 = 1;
