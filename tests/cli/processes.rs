//! Each epoch of a scene is measured in a process of its own.

use std::io::Write;
use std::path::Path;
use std::process::Stdio;

use serde_json::Value;
use tempfile::TempDir;

use super::command::{command, json, prints, stderr};
use super::journal::{answers, cases};

const SMALL: [&str; 13] =
    ["compare", "cube", "torus", "-s", "sah-kd", "-s", "sah-bvh", "-w", "diffuse", "--rays", "256", "--epochs", "2"];

/// The numbers of the processes that have measured the cases of a journal.
fn processes(folder: &Path) -> Vec<u64> {
    let process = |path| json(path)["epoch"]["environment"]["process"].as_u64().unwrap();
    let mut all: Vec<u64> = cases(folder, "compare").iter().map(process).collect();
    all.sort_unstable();
    all.dedup();
    all
}

#[test]
fn each_epoch_of_a_scene_has_a_process_and_one_process_answers_the_same() {
    let folder = TempDir::new().unwrap();
    let [apart, one] = ["apart", "one"].map(|name| folder.path().join(name));
    let run = |dir: &Path, more: &[&str]| prints(&[&SMALL[..], &["--dir", dir.to_str().unwrap()], more].concat());
    run(&apart, &[]);
    run(&one, &["--in-process"]);
    assert_eq!((processes(&apart).len(), processes(&one).len()), (4, 1), "two epochs of two scenes");
    assert_eq!(answers(&apart, "compare"), answers(&one, "compare"));
    // Both kinds lie side by side.
    run(&apart, &["--in-process"]);
    assert_eq!(cases(&apart, "compare").len(), 8);
}

/// What a process with a case says to a run that listens, given answers.
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
    prints(&[&SMALL[..], &["--dir", folder.path().to_str().unwrap()]].concat());
    let first = json(&cases(folder.path(), "compare")[0]);
    let out = folder.path().join("again.json");
    let lines = said(&first["case"], &out);
    assert!(lines.iter().any(|line| line["Stage"]["Build"] == "sah-bvh"), "{lines:?}");
    let checksums = |file: &Value| -> Vec<Value> {
        let structures = file["epoch"]["structures"].as_array().unwrap();
        structures.iter().map(|structure| structure["rays"][0]["checksum"].clone()).collect()
    };
    assert_eq!(checksums(&json(&out)), checksums(&first));

    // A scene that has changed is refused, in the words that the run shows.
    let mut changed = first["case"].clone();
    changed["scene"]["hash"] = "0123456789abcdef".into();
    let lines = said(&changed, &folder.path().join("never.json"));
    let sentence = lines[0]["Failed"]["sentence"].as_str().unwrap();
    assert!(sentence.contains("cube") && sentence.contains("plan it anew"), "{sentence}");
    assert!(!folder.path().join("never.json").exists());
}
