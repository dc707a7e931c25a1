//! Runs the command `sahara`, and checks its output.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

use serde_json::Value;
use tempfile::TempDir;

pub const RIGHT: i32 = 0;
pub const USAGE: i32 = 1;
pub const WRONG: i32 = 2;
pub const REGRESSION: i32 = 3;
pub const NOT_BUILT: i32 = 5;

pub const SQUARE: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n";

/// The arguments in `line` are quoted as for a shell.
pub fn command(line: &str) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_sahara"));
    command.args(shlex::split(line).unwrap_or_else(|| panic!("{line}"))).stdin(Stdio::null());
    ["SAHARA_DATA", "NO_COLOR", "CLICOLOR_FORCE", "COLUMNS"].iter().for_each(|name| _ = command.env_remove(name));
    command
}

/// Standard output and standard error.
pub fn output_texts(output: &Output) -> [String; 2] {
    [&output.stdout, &output.stderr].map(|text| String::from_utf8(text.clone()).expect("output is UTF-8"))
}

/// The command must exit with `status`. Returns standard output and standard error.
#[track_caller]
pub fn ends(status: i32, command: &mut Command) -> [String; 2] {
    let output = command.output().expect("the command runs");
    assert_eq!(output.status.code(), Some(status), "{command:?}: {:?}", output_texts(&output));
    output_texts(&output)
}

#[track_caller]
pub fn assert_contains(text: &str, parts: &[&str]) {
    for part in parts {
        assert!(text.contains(part), "{part:?} is not in {text}");
    }
}

/// The command must fail with an empty standard output. The error message must contain all `parts`.
#[track_caller]
pub fn refused(command: &mut Command, parts: &[&str]) -> String {
    let [text, message] = ends(USAGE, command);
    assert_eq!(text, "", "{message}");
    assert!(message.starts_with("error: "), "{message}");
    assert!(!message.contains("panicked") && !message.contains("backtrace"), "{message}");
    assert_contains(&message, parts);
    message
}

/// Like [`refused`], but the message must be a single line.
#[track_caller]
pub fn refused_in_a_line(command: &mut Command, parts: &[&str]) {
    let message = refused(command, parts);
    assert_eq!(message.lines().count(), 1, "{message}");
}

/// The text as a single line.
pub fn unwrapped(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

#[track_caller]
pub fn json(path: impl AsRef<Path>) -> Value {
    serde_json::from_slice(&fs::read(path).unwrap()).unwrap()
}

pub struct Folder(TempDir);

impl Folder {
    pub fn new() -> Self {
        Self(TempDir::new().unwrap())
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    pub fn write(&self, name: &str, content: impl AsRef<[u8]>) {
        fs::write(self.path(name), content).unwrap();
    }

    pub fn read(&self, name: &str) -> String {
        fs::read_to_string(self.path(name)).unwrap()
    }

    pub fn names(&self) -> Vec<String> {
        let entries = fs::read_dir(&self.0).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap());
        let mut names: Vec<String> = entries.collect();
        names.sort();
        names
    }

    #[cfg(unix)]
    pub fn program(&self, name: &str, text: &str) {
        use std::os::unix::fs::PermissionsExt;
        fs::create_dir_all(self.path(name).parent().unwrap()).unwrap();
        self.write(name, text);
        fs::set_permissions(self.path(name), fs::Permissions::from_mode(0o755)).unwrap();
    }

    pub fn command(&self, line: &str) -> Command {
        let mut command = command(line);
        command.current_dir(&self.0);
        command
    }

    #[track_caller]
    pub fn ends(&self, status: i32, line: &str) -> [String; 2] {
        ends(status, &mut self.command(line))
    }

    #[track_caller]
    pub fn prints(&self, line: &str) -> String {
        let [text, _] = self.ends(RIGHT, line);
        text
    }

    #[track_caller]
    pub fn shows(&self, line: &str, parts: &[&str]) -> String {
        let text = self.prints(line);
        assert_contains(&text, parts);
        text
    }

    #[track_caller]
    pub fn refuses(&self, line: &str, parts: &[&str]) -> String {
        refused(&mut self.command(&format!("--quiet {line}")), parts)
    }

    #[track_caller]
    pub fn refuses_in_a_line(&self, line: &str, parts: &[&str]) {
        refused_in_a_line(&mut self.command(&format!("--quiet {line}")), parts);
    }
}
