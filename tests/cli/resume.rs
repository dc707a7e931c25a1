//! A study that is killed in the middle goes on where it stopped, and ends as one that was left alone.

use std::fs;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use super::command::{RIGHT, command, stderr, words};
use super::journal::{answers, cases};

/// A study of seconds, of twelve epochs, into the folder `dir`.
fn study(dir: &Path) -> Command {
    let mut command = command(&words("study attribution cube --rays 64 --runs 1 --budget 1 --epochs 12 --quiet --dir"));
    command.arg(dir).stdout(Stdio::piped()).stderr(Stdio::piped());
    command
}

#[track_caller]
fn finish(dir: &Path) {
    let output = study(dir).output().expect("the command runs");
    assert_eq!(output.status.code(), Some(RIGHT), "{}", stderr(&output));
}

/// Kills it as `kill -9` does, as soon as the journal has `wanted` cases.
fn kill_at(mut child: Child, dir: &Path, wanted: usize) {
    let start = Instant::now();
    while cases(dir, "attribution").len() < wanted {
        assert!(child.try_wait().unwrap().is_none(), "it ended before it could be killed");
        assert!(start.elapsed() < Duration::from_secs(600), "it measures nothing");
        std::thread::sleep(Duration::from_millis(2));
    }
    child.kill().unwrap();
    assert!(!child.wait().unwrap().success());
}

#[test]
fn a_killed_study_ends_as_one_that_was_left_alone() {
    let folder = tempfile::tempdir().unwrap();
    let (alone, killed) = (folder.path().join("alone"), folder.path().join("killed"));
    finish(&alone);

    // Once with a case, and once with another one.
    kill_at(study(&killed).spawn().unwrap(), &killed, 1);
    kill_at(study(&killed).spawn().unwrap(), &killed, 2);
    // As if the power had failed while a case was written.
    fs::write(killed.join("attribution/.sahara-1234.part"), "{\"schema\":4,\"pr").unwrap();
    let before = cases(&killed, "attribution").len();

    finish(&killed);
    assert!(before < cases(&killed, "attribution").len());
    assert_eq!(answers(&alone, "attribution").len(), 12);
    assert_eq!(answers(&killed, "attribution"), answers(&alone, "attribution"));
}

#[cfg(unix)]
#[test]
fn a_run_is_refused_while_another_one_measures_into_its_folder() {
    let folder = tempfile::tempdir().unwrap();
    let journal = folder.path().join("attribution");
    fs::create_dir(&journal).unwrap();
    // As another run holds it.
    let lock = fs::File::open(&journal).unwrap();
    lock.lock().unwrap();
    let second = study(folder.path()).output().unwrap();
    super::command::refused_in_a_line(&second, &["another run is measuring into", "attribution", "--dir"]);
    assert!(cases(folder.path(), "attribution").is_empty());

    lock.unlock().unwrap();
    finish(folder.path());
    // With nothing left to measure it shows what there is.
    lock.lock().unwrap();
    finish(folder.path());
}
