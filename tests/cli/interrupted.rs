//! Interrupts runs with signals and checks how the runs end.

use std::fs;
use std::io::{BufRead, BufReader, Read};
use std::os::unix::process::{CommandExt, ExitStatusExt};
use std::process::{Child, Command, ExitStatus, Stdio};
use std::thread;
use std::time::Duration;

use nix::sys::signal::{self, SigHandler, Signal, kill};
use nix::unistd::Pid;

use super::command::{Folder, RIGHT, ends};
use super::corpus::files;
use super::plan::{file, job, plan};
use super::runner::NOTHING;

const CASES: usize = 16;

/// A comparison that takes some seconds.
fn compare(folder: &Folder, more: &str) -> Command {
    let small = "compare torus cube -s sah-kd -s sah-bvh -w primary --rays 256 --epochs 8";
    let mut command = folder.command(&format!("{small} {more}"));
    command.stdout(Stdio::piped()).stderr(Stdio::piped());
    command
}

/// In the child, `handler` replaces the inherited handling of SIGINT and SIGTERM.
fn spawn(mut command: Command, handler: SigHandler) -> Child {
    // SAFETY: `signal` is async-signal-safe. The closure allocates no memory.
    unsafe {
        command.pre_exec(move || {
            for caught in [Signal::SIGINT, Signal::SIGTERM] {
                signal::signal(caught, handler)?;
            }
            Ok(())
        });
    }
    command.spawn().unwrap()
}

/// Sends SIGINT to a run after the first table, the table of the cube.
fn signalled(folder: &Folder, more: &str, handler: SigHandler) -> (ExitStatus, String) {
    let mut child = spawn(compare(folder, more), handler);
    let mut reader = BufReader::new(child.stdout.take().unwrap());
    let mut text = String::new();
    while !text.ends_with("\n\n") {
        assert!(reader.read_line(&mut text).unwrap() > 0, "it ended without a table: {text}");
    }
    assert!(text.starts_with("Cube: 12 triangles; million rays per second\n"), "{text}");
    kill(Pid::from_raw(child.id() as i32), Signal::SIGINT).unwrap();
    reader.read_to_string(&mut text).unwrap();
    (child.wait().unwrap(), text)
}

fn interrupted(folder: &Folder, more: &str) -> String {
    let (status, text) = signalled(folder, more, SigHandler::SigDfl);
    assert_eq!(status.signal(), Some(Signal::SIGINT as i32), "{text}");
    text
}

/// The number of measured cases, including all 8 cases of the cube.
fn measured(text: &str) -> usize {
    let progress =
        text.split("Interrupted: ").nth(1).unwrap_or_else(|| panic!("no line about the interruption: {text}"));
    let number = progress.split(' ').next().unwrap().parse().unwrap();
    assert!(progress.contains(&format!(" of {CASES} cases")) && (8..CASES).contains(&number), "{text}");
    number
}

/// The number of processes whose working directory is `folder`.
fn processes(folder: &Folder) -> usize {
    let folder = folder.path("").canonicalize().unwrap();
    let entries = fs::read_dir("/proc").unwrap().flatten();
    entries.filter(|entry| fs::read_link(entry.path().join("cwd")).is_ok_and(|cwd| cwd == folder)).count()
}

/// Waits, because the system takes a moment to remove a killed process.
#[track_caller]
fn wait_until_no_process(folder: &Folder) {
    let is_left = (0..500).any(|_| {
        thread::sleep(Duration::from_millis(10));
        processes(folder) == 0
    });
    assert!(is_left, "{} processes still run", processes(folder));
}

#[test]
fn what_is_interrupted_is_shown_and_nothing_goes_on() {
    let folder = Folder::new();
    let text = interrupted(&folder, "--export-json r.json");
    let before = measured(&text);
    assert_eq!(processes(&folder), 0, "no process may remain");
    assert!(before == 8 || text.contains(&format!(" ({} of 8 epochs)", before - 8)), "{text}");
    assert!(text.contains("--dir DIR keeps") && folder.names().is_empty(), "{text}");
}

#[test]
fn a_journal_that_was_interrupted_is_only_added_to() {
    let folder = Folder::new();
    let before = measured(&interrupted(&folder, "--dir kept"));
    let journal = folder.path("kept/compare");
    let kept = files(&journal);
    assert_eq!(kept.len(), before);
    ends(RIGHT, &mut compare(&folder, "--dir kept"));
    let whole = files(&journal);
    assert!(whole.len() == CASES && kept.iter().all(|(name, bytes)| whole.get(name) == Some(bytes)));
}

/// Checks that `signal` ends a process that has printed `message`.
#[track_caller]
fn ends_by(signal: Signal, command: Command, message: &str) {
    let mut child = spawn(command, SigHandler::SigDfl);
    let mut line = String::new();
    BufReader::new(child.stderr.take().unwrap()).read_line(&mut line).unwrap();
    assert_eq!(line, message);
    kill(Pid::from_raw(child.id() as i32), signal).unwrap();
    assert_eq!(child.wait().unwrap().signal(), Some(signal as i32));
}

#[test]
fn a_job_ends_at_once_and_leaves_nothing() {
    let folder = Folder::new();
    // Without a signal, a job takes half a minute.
    let lines = plan(&folder.path(""), "attribution --scenes sphere --runs 1000 --budget 30 --epochs 2");
    for signal in [Signal::SIGINT, Signal::SIGKILL] {
        ends_by(signal, job(&lines[1]), "measuring attribution, epoch 2 of 2: Sphere\n");
        assert_eq!(fs::read_dir(file(&lines[1]).parent().unwrap()).unwrap().count(), 0);
    }
}

#[test]
fn what_was_started_to_ignore_ctrl_c_goes_on() {
    let (status, text) = signalled(&Folder::new(), "", SigHandler::SigIgn);
    assert!(status.code() == Some(RIGHT) && !text.contains("Interrupted"), "{text}");
}

#[test]
fn what_a_runner_has_started_ends_with_the_run_and_one_that_does_not_answer_with_the_command() {
    let folder = Folder::new();
    folder.program("nothing.sh", NOTHING);
    interrupted(&folder, "--runner './nothing.sh leaves'");
    wait_until_no_process(&folder);
    for signal in [Signal::SIGINT, Signal::SIGTERM] {
        ends_by(signal, compare(&folder, "--runner \"sh -c 'echo here >&2; sleep 600; exit'\""), "here\n");
        wait_until_no_process(&folder);
    }
}
