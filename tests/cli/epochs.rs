//! Studies of several epochs from outside: the files that they keep, add and reject; each epoch of a scene is measured
//! in a separate process.

use std::collections::BTreeSet;
use std::fs;
use std::io::Write;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use serde_json::Value;
use tempfile::TempDir;

use super::command::{RIGHT, command, ends, json, prints, stderr, words};
use super::journal::{answers, cases};

#[test]
fn a_study_goes_on_where_it_stopped_and_repeats_what_it_said() {
    for (name, study) in [
        ("scaling", "study scaling cube --finest 2 -s median-kd -s sah-bvh"),
        ("compare", "compare cube torus -s median-kd -s sah-kd"),
    ] {
        let folder = TempDir::new().unwrap();
        let dir = folder.path().to_str().unwrap();
        let cases = || cases(folder.path(), name);
        let run = |options: &str| {
            let small = format!("{study} -w primary --rays 64 --runs 1 --budget 1 --dir {dir} --epochs {options}");
            (prints(&words(&small)), cases().len())
        };
        let (first, measured) = run("1");
        assert!(measured > 0, "{study}");
        assert_eq!(run("1"), (first, measured), "{study} measures nothing again");
        // A second epoch doubles the number of cases.
        assert_eq!(run("2").1, 2 * measured, "{study}");
        // A removed case is measured again.
        fs::remove_file(&cases()[0]).unwrap();
        assert_eq!(run("2").1, 2 * measured, "{study}");
        // Files of other settings lie beside, and a repeated measurement keeps the old file.
        assert_eq!(run("1 --seed 2").1, 3 * measured, "{study}");
        assert_eq!(run("1 --fresh").1, 4 * measured, "{study}");
    }
}

/// A study of seconds, of twelve epochs, into the folder `dir`.
fn study(dir: &Path) -> Command {
    let mut command = command(&words("study attribution cube --rays 64 --runs 1 --budget 1 --epochs 12 --quiet --dir"));
    command.arg(dir).stdout(Stdio::piped()).stderr(Stdio::piped());
    command
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
    let folder = TempDir::new().unwrap();
    let (alone, killed) = (folder.path().join("alone"), folder.path().join("killed"));
    ends(RIGHT, &mut study(&alone));

    // Once with one case, and once with another.
    kill_at(study(&killed).spawn().unwrap(), &killed, 1);
    kill_at(study(&killed).spawn().unwrap(), &killed, 2);
    // As after a power failure while a case was written.
    fs::write(killed.join("attribution/.sahara-1234.part"), "{\"schema\":4,\"pr").unwrap();
    let before = cases(&killed, "attribution").len();

    ends(RIGHT, &mut study(&killed));
    assert!(before < cases(&killed, "attribution").len());
    assert_eq!(answers(&alone, "attribution").len(), 12);
    assert_eq!(answers(&killed, "attribution"), answers(&alone, "attribution"));
}

const TWO_SCENES: &str = "compare cube torus -s sah-kd -s sah-bvh -w diffuse --rays 256 --epochs 2 --dir";

/// The numbers of the processes that measured the cases of a journal.
fn processes(folder: &Path) -> BTreeSet<u64> {
    let process = |path| json(path)["epoch"]["environment"]["process"].as_u64().unwrap();
    cases(folder, "compare").iter().map(process).collect()
}

#[test]
fn each_epoch_of_a_scene_has_a_process_and_one_process_answers_the_same() {
    let folder = TempDir::new().unwrap();
    let [apart, one] = ["apart", "one"].map(|name| folder.path().join(name));
    let run = |dir: &Path, more: &[&str]| prints(&[&words(TWO_SCENES)[..], &[dir.to_str().unwrap()], more].concat());
    run(&apart, &[]);
    run(&one, &["--in-process"]);
    assert_eq!((processes(&apart).len(), processes(&one).len()), (4, 1), "two epochs of two scenes");
    assert_eq!(answers(&apart, "compare"), answers(&one, "compare"));
    // Both kinds lie side by side.
    run(&apart, &["--in-process"]);
    assert_eq!(cases(&apart, "compare").len(), 8);
}

/// The messages of a process with a case to a listening run, with replies.
fn said(case: &Value, out: &Path) -> Vec<Value> {
    let mut command = command(&[&format!("--case={case}"), "--out", out.to_str().unwrap(), "--listen"]);
    let mut child = command.stdin(Stdio::piped()).stdout(Stdio::piped()).spawn().unwrap();
    // It may have ended before.
    let _ = child.stdin.take().unwrap().write_all("\n".repeat(10_000).as_bytes());
    let output = child.wait_with_output().unwrap();
    assert!(output.status.success(), "{}", stderr(&output));
    let lines = String::from_utf8(output.stdout).unwrap();
    let line = |line: &str| serde_json::from_str(line.strip_prefix("\u{1e}case ").unwrap()).unwrap();
    lines.lines().map(line).collect()
}

#[test]
fn a_process_measures_its_case_alone_and_says_what_it_does() {
    let folder = TempDir::new().unwrap();
    prints(&[&words(TWO_SCENES)[..], &[folder.path().to_str().unwrap()]].concat());
    let first = json(&cases(folder.path(), "compare")[0]);
    let out = folder.path().join("again.json");
    let lines = said(&first["case"], &out);
    assert!(lines.iter().any(|line| line["Stage"]["Build"] == "sah-bvh"), "{lines:?}");
    let checksums = |file: &Value| -> Vec<Value> {
        let structures = file["epoch"]["structures"].as_array().unwrap();
        structures.iter().map(|structure| structure["rays"][0]["checksum"].clone()).collect()
    };
    assert_eq!(checksums(&json(&out)), checksums(&first));

    // A changed scene is rejected, with the error that the run shows.
    let mut changed = first["case"].clone();
    changed["scene"]["hash"] = "0123456789abcdef".into();
    let lines = said(&changed, &folder.path().join("never.json"));
    let sentence = lines[0]["Failed"]["sentence"].as_str().unwrap();
    assert!(sentence.contains("cube") && sentence.contains("plan it again"), "{sentence}");
    assert!(!folder.path().join("never.json").exists());
}
