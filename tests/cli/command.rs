//! Runs the command, and checks its output.

use std::fs;
use std::path::Path;
use std::process::{Command, Output, Stdio};

use serde_json::Value;
use tempfile::TempDir;

pub const RIGHT: i32 = 0;
pub const USAGE: i32 = 1;
pub const WRONG: i32 = 2;
pub const REGRESSION: i32 = 3;
pub const NOT_BUILT: i32 = 5;

/// The words of a command line without quotes.
pub fn words(line: &str) -> Vec<&str> {
    line.split(' ').collect()
}

/// The command in a fixed environment: without real meshes.
pub fn command(args: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_sahara"));
    command.args(args).env_remove("SAHARA_DATA").stdin(Stdio::null());
    ["NO_COLOR", "CLICOLOR_FORCE", "COLUMNS"].iter().for_each(|name| _ = command.env_remove(name));
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

/// The output of a successful command.
#[track_caller]
pub fn prints(args: &[&str]) -> String {
    printed(&mut command(args))
}

/// Like [`prints`], for a prepared command.
#[track_caller]
pub fn printed(command: &mut Command) -> String {
    let output = command.output().expect("the command runs");
    assert_eq!(output.status.code(), Some(RIGHT), "{command:?}: {}{}", stdout(&output), stderr(&output));
    stdout(&output)
}

/// Checks that a command has failed with one message that contains all of `parts`, which is returned, and that it
/// printed no result.
#[track_caller]
fn refused(output: &Output, parts: &[&str]) -> String {
    let message = stderr(output);
    assert_eq!(output.status.code(), Some(USAGE), "{message}");
    assert!(output.stdout.is_empty(), "{message}: it prints {}", stdout(output));
    assert!(message.starts_with("error: "), "{message}");
    assert!(!message.contains("panicked") && !message.contains("backtrace"), "{message}");
    for part in parts {
        assert!(message.contains(part), "{part:?} is not in {message:?}");
    }
    message
}

/// Like [`refused`], in one line.
#[track_caller]
pub fn refused_in_a_line(output: &Output, parts: &[&str]) {
    let message = refused(output, parts);
    assert_eq!(message.lines().count(), 1, "{message}");
}

/// Like [`refused`], for the command with these arguments.
#[track_caller]
pub fn refuses(args: &[&str], parts: &[&str]) -> String {
    refused(&sahara(&[&["--quiet"], args].concat()), parts)
}

/// Like [`refuses`], in one line.
#[track_caller]
pub fn refuses_in_a_line(args: &[&str], parts: &[&str]) {
    refused_in_a_line(&sahara(&[&["--quiet"], args].concat()), parts);
}

/// The content of a JSON file.
#[track_caller]
pub fn json(path: impl AsRef<Path>) -> Value {
    serde_json::from_slice(&fs::read(path).unwrap()).unwrap()
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
