//! Commands that start runners.

use std::path::Path;
use std::time::Duration;

use super::session::{Session, unexpected};
use crate::accel::Capabilities;
use crate::measure::program::file_id;

/// A program that implements the protocol of runners.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Program {
    /// The valid `NAME` of `NAME=COMMAND`.
    name: Option<String>,
    command: String,
    /// The program and its arguments, split by the rules of a shell.
    words: Vec<String>,
    limit: Duration,
}

impl Program {
    /// Starts the program once as a check.
    pub fn new(command: &str, limit: Duration) -> Result<Self, String> {
        let named = command.split_once('=').filter(|(name, _)| is_name(name));
        let (name, line) = named.map_or((None, command), |(name, line)| (Some(name.to_owned()), line));
        let words = shlex::split(line).filter(|words| !words.is_empty());
        let words = words.ok_or("a runner is a program with its arguments: quote arguments that contain spaces")?;
        let program = Self { name, command: command.into(), words, limit };
        program.start(1).map(|_| program)
    }

    /// The command as typed.
    pub fn command(&self) -> &str {
        &self.command
    }

    pub fn name(&self) -> String {
        self.name.clone().unwrap_or_else(|| {
            let file = Path::new(&self.words[0]).file_name().unwrap_or_default().to_string_lossy().into_owned();
            [&[file], &self.words[1..]].concat().join(" ")
        })
    }

    /// Identifies the contents of all readable files that the command names. `None` if the command names no readable
    /// file.
    pub fn build_id(&self) -> Option<String> {
        let ids: Vec<String> = self.words.iter().filter_map(|word| file_id(Path::new(word)).ok()).collect();
        (!ids.is_empty()).then(|| ids.join(" "))
    }

    fn advice_on_name(&self) -> String {
        match self.command.split_once('=') {
            Some((text, _)) if !is_name(text) => format!(
                "; {text:?}, before the first \"=\", is not a valid NAME: use only letters, digits, \"-\" and \"_\""
            ),
            _ => String::new(),
        }
    }

    /// The first reply of the program states the supported queries.
    pub(super) fn start(&self, threads: usize) -> Result<(Session, Capabilities), String> {
        let session = Session::start(&self.words, threads, self.limit);
        let mut session = session.map_err(|problem| problem + &self.advice_on_name())?;
        let request = format!("sahara {VERSION} {threads}");
        let reply = session.request(&request)?.text;
        match reply.strip_prefix(&format!("runner {VERSION} ")) {
            Some("closest any") => Ok((session, Capabilities::ALL)),
            Some("closest") => Ok((session, Capabilities { any_hit: false, ..Capabilities::ALL })),
            _ => Err(unexpected(&request, &reply, "runner 1 closest any")),
        }
    }
}

fn is_name(text: &str) -> bool {
    let is_plain = |c: char| c.is_ascii_alphanumeric() || c == '-' || c == '_';
    !text.is_empty() && text.chars().all(is_plain)
}

/// The version of the protocol.
const VERSION: u32 = 1;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_build_is_the_program_with_the_files_that_it_is_given() {
        let folder = tempfile::tempdir().unwrap();
        let write = |name: &str| {
            let path = folder.path().join(name);
            std::fs::write(&path, name).unwrap();
            path.to_str().unwrap().to_owned()
        };
        let [python, script] = ["python", "run.py"].map(write);
        let id = |words: &[&str]| {
            let words = words.iter().map(|word| (*word).to_owned()).collect();
            Program { name: None, command: String::new(), words, limit: Duration::ZERO }.build_id()
        };
        let of = |word: &str| id(&[word]).unwrap();
        assert_eq!(id(&[&python, "-u", &script]).unwrap(), format!("{} {}", of(&python), of(&script)));
        assert_eq!((id(&["python", &script]), id(&["no such program"])), (Some(of(&script)), None));
    }
}
