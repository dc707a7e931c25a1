//! Running the command, and what it says.

use std::fs;
use std::path::Path;
use std::process::{Command, Output, Stdio};

use tempfile::TempDir;

pub const RIGHT: i32 = 0;
pub const USAGE: i32 = 1;
pub const WRONG: i32 = 2;
pub const REGRESSION: i32 = 3;
pub const NOISE: i32 = 4;

/// The command, whatever the environment of the tests is: without real meshes.
pub fn command(args: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_sahara"));
    command.args(args).env_remove("SAHARA_DATA").env_remove("NO_COLOR").stdin(Stdio::null());
    command
}

pub fn sahara(args: &[&str]) -> Output {
    command(args).output().expect("the command runs")
}

pub fn stdout(output: &Output) -> String {
    String::from_utf8(output.stdout.clone()).expect("output is UTF-8")
}

pub fn stderr(output: &Output) -> String {
    String::from_utf8(output.stderr.clone()).expect("messages are UTF-8")
}

/// What a command that succeeds prints.
#[track_caller]
pub fn prints(args: &[&str]) -> String {
    let output = sahara(args);
    assert_eq!(output.status.code(), Some(RIGHT), "{args:?}: {}", stderr(&output));
    stdout(&output)
}

/// The command fails, prints nothing as a result, and one message that holds all of `parts`. The message is given.
#[track_caller]
pub fn refuses(args: &[&str], parts: &[&str]) -> String {
    let output = sahara(&[&["--quiet"], args].concat());
    let message = stderr(&output);
    assert_eq!(output.status.code(), Some(USAGE), "{args:?}: {message}");
    assert!(output.stdout.is_empty(), "{args:?} prints {}", stdout(&output));
    assert!(message.starts_with("error: "), "{args:?}: {message}");
    assert!(!message.contains("panicked") && !message.contains("backtrace"), "{args:?}: {message}");
    for part in parts {
        assert!(message.contains(part), "{args:?}: {part:?} is not in {message:?}");
    }
    message
}

/// As [`refuses`], in one line.
#[track_caller]
pub fn refuses_in_a_line(args: &[&str], parts: &[&str]) {
    let message = refuses(args, parts);
    assert_eq!(message.lines().count(), 1, "{args:?}: {message}");
}

/// The path of a new file.
pub fn write(directory: &TempDir, name: &str, text: &str) -> String {
    let path = directory.path().join(name);
    fs::write(&path, text).unwrap();
    path_text(&path)
}

pub fn path_text(path: &Path) -> String {
    path.to_str().unwrap().to_owned()
}

/// A mesh of one square.
pub const SQUARE: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n";

/// A comparison that takes no time.
pub fn small(scene: &str) -> Vec<&str> {
    vec!["compare", scene, "--rays", "400", "--runs", "2", "--budget", "1", "-w", "primary", "-w", "shadow"]
}
