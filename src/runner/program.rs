//! The program of a runner.

use std::fs::File;
use std::io::Read;
use std::path::Path;
use std::time::Duration;

use super::session::{Session, unexpected};
use crate::accel::Capabilities;
use crate::measure::program::file_id;

/// A program that implements the protocol, with the time limit for its replies.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Program {
    /// The name before the first `=`, of letters, digits, `-` and `_`.
    name: Option<String>,
    command: String,
    /// The command, split as a shell does.
    words: Vec<String>,
    limit: Duration,
}

impl Program {
    /// Checks the program by starting it once.
    ///
    /// # Errors
    /// A sentence, if the command is empty, cannot be started or does not implement the protocol.
    pub fn new(command: &str, limit: Duration) -> Result<Self, String> {
        let is_plain = |c: char| c.is_ascii_alphanumeric() || c == '-' || c == '_';
        let named = command.split_once('=').filter(|(name, _)| !name.is_empty() && name.chars().all(is_plain));
        let (name, line) = named.map_or((None, command), |(name, line)| (Some(name.to_owned()), line));
        let words = shlex::split(line).filter(|words| !words.is_empty());
        let words = words.ok_or("a runner is a program and its arguments, in quotes where they hold spaces")?;
        let program = Self { name, command: command.into(), words, limit };
        program.start(1).map(|_| program)
    }

    /// The command as typed.
    pub fn command(&self) -> &str {
        &self.command
    }

    /// The name that it was given; else that of the program without its folder, and the arguments.
    pub fn name(&self) -> String {
        if let Some(name) = &self.name {
            return name.clone();
        }
        let file = Path::new(&self.words[0]).file_name().unwrap_or_default().to_string_lossy().into_owned();
        [&[file], &self.words[1..]].concat().join(" ")
    }

    /// Identifies the build: the first digits of the SHA-256 of its file, and of the script or program among its
    /// arguments, which an interpreter or a wrapper like `taskset` runs. None if it is found on the search path and has
    /// no such argument.
    pub fn build_id(&self) -> Option<String> {
        let (program, arguments) = self.words.split_first()?;
        let script = arguments.iter().find(|word| is_program(Path::new(word)));
        let ids: Vec<String> =
            [Some(program), script].into_iter().flatten().filter_map(|file| file_id(Path::new(file)).ok()).collect();
        (!ids.is_empty()).then(|| ids.join(" "))
    }

    /// Starts the program and learns which queries it supports.
    pub(super) fn start(&self, threads: usize) -> Result<(Session, Capabilities), String> {
        let mut session = Session::start(&self.words, threads, self.limit)?;
        let request = format!("sahara {VERSION} {threads}");
        let reply = session.request(&request)?.text;
        match reply.strip_prefix(&format!("runner {VERSION} ")) {
            Some("closest any") => Ok((session, Capabilities::ALL)),
            Some("closest") => Ok((session, Capabilities { any_hit: false, ..Capabilities::ALL })),
            _ => Err(unexpected(&request, &reply, "runner 1 closest any")),
        }
    }
}

/// Whether a file is a program or a script, by its extension or its first bytes.
fn is_program(path: &Path) -> bool {
    const EXTENSIONS: [&str; 10] = ["jar", "jl", "js", "lua", "mjs", "pl", "py", "rb", "sh", "ts"];
    // Scripts that name their interpreter, programs of Linux and of Windows.
    const BEGINNINGS: [&[u8; 2]; 3] = [b"#!", b"\x7fE", b"MZ"];
    let is_named_so =
        path.extension().and_then(|ending| ending.to_str()).is_some_and(|ending| EXTENSIONS.contains(&ending));
    let mut first = [0; 2];
    let mut begins_so =
        || File::open(path).and_then(|mut file| file.read_exact(&mut first)).is_ok() && BEGINNINGS.contains(&&first);
    path.is_file() && (is_named_so || begins_so())
}

/// Version of the protocol.
const VERSION: u32 = 1;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_build_is_the_program_with_its_script_and_no_data() {
        let folder = tempfile::tempdir().unwrap();
        let write = |name: &str, text: &str| {
            std::fs::write(folder.path().join(name), text).unwrap();
            folder.path().join(name).to_str().unwrap().to_owned()
        };
        let [python, script, data] =
            [("python", "elf"), ("run.py", "1"), ("cache.bin", "2")].map(|(name, text)| write(name, text));
        let id = |words: &[&str]| {
            let words = words.iter().map(|word| (*word).to_owned()).collect();
            Program { name: None, command: String::new(), words, limit: Duration::ZERO }.build_id()
        };
        let of = |word: &str| id(&[word]).unwrap();
        assert_eq!(id(&[&python, "-u", &script, &data]).unwrap(), format!("{} {}", of(&python), of(&script)));
        assert_eq!(id(&[&python, "--cache", &data]).unwrap(), of(&python));
        assert_eq!(id(&["python", &script]).unwrap(), of(&script));
        assert_eq!(id(&["no such program", &data]), None);
        let bound = write("bvh", "\x7fELF");
        assert_eq!(id(&["taskset", "-c", "2", &bound, &data]).unwrap(), of(&bound));
        let named = write("run", "#!/usr/bin/env python\n");
        assert_eq!(id(&["python", &named]).unwrap(), of(&named));
    }
}
