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
    ends(RIGHT, &mut command(args)).0
}

/// The output and the messages of a command, which must end with this status.
#[track_caller]
pub fn ends(status: i32, command: &mut Command) -> (String, String) {
    let output = command.output().expect("the command runs");
    let (text, messages) = (stdout(&output), stderr(&output));
    assert_eq!(output.status.code(), Some(status), "{command:?}: {text}{messages}");
    (text, messages)
}

/// A text in one line: the terminal breaks lines anywhere.
pub fn unwrapped(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
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

/// The path of a file in a folder.
pub fn at(folder: &TempDir, name: &str) -> String {
    path_text(&folder.path().join(name))
}

/// The path of a new file.
pub fn write(folder: &TempDir, name: &str, text: &str) -> String {
    fs::write(folder.path().join(name), text).unwrap();
    at(folder, name)
}

/// The path of a new executable file.
#[cfg(unix)]
pub fn program(folder: &TempDir, name: &str, text: &str) -> String {
    use std::os::unix::fs::PermissionsExt;
    fs::create_dir_all(folder.path().join(name).parent().unwrap()).unwrap();
    let path = write(folder, name, text);
    fs::set_permissions(&path, fs::Permissions::from_mode(0o755)).unwrap();
    path
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
