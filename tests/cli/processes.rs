//! Each epoch of a scene is measured in a process of its own.

use std::io::Write;
use std::path::Path;
use std::process::Stdio;

use serde_json::Value;
use tempfile::TempDir;

use super::command::{command, json, prints, refuses, stderr};
use super::journal;

const SMALL: [&str; 13] =
    ["compare", "cube", "torus", "-s", "sah-kd", "-s", "sah-bvh", "-w", "diffuse", "--rays", "256", "--epochs", "2"];

/// What no clock decides, of every record.
fn answers(text: &[u8]) -> Vec<Value> {
    let records: Vec<Value> = serde_json::from_slice(text).unwrap();
    let kept = ["scene", "scene_hash", "label", "workload_hash", "rays", "hits", "answers", "tests_per_ray", "bytes"];
    records.iter().map(|record| kept.map(|key| record[key].clone()).into_iter().collect()).collect()
}

#[test]
fn all_in_one_process_answers_the_same() {
    let folder = TempDir::new().unwrap();
    let run = |name: &str, more: &[&str]| {
        let file = folder.path().join(name);
        prints(&[&SMALL[..], &["--export-json", file.to_str().unwrap()], more].concat());
        answers(&std::fs::read(file).unwrap())
    };
    let apart = run("apart.json", &[]);
    assert_eq!(apart.len(), 4);
    assert_eq!(apart, run("one.json", &["--in-process"]));
}

/// The cases of a journal, by their keys.
fn cases(folder: &Path) -> Vec<Value> {
    let mut cases: Vec<Value> = journal::cases(folder, "compare").iter().map(json).collect();
    cases.sort_by_key(|case| case["key"].as_str().unwrap().to_owned());
    cases
}

/// The numbers of the processes that have measured the cases of a journal.
fn processes(folder: &Path) -> Vec<u64> {
    cases(folder).iter().map(|case| case["case"]["circumstances"]["process"].as_u64().unwrap()).collect()
}

#[test]
fn each_epoch_of_a_scene_has_a_process_and_journals_do_not_mix() {
    let folder = TempDir::new().unwrap();
    let dir = ["--dir", folder.path().to_str().unwrap()];
    prints(&[&SMALL[..], &dir].concat());
    let mut apart = processes(folder.path());
    apart.sort_unstable();
    apart.dedup();
    assert_eq!(apart.len(), 4, "two epochs of two scenes");
    refuses(&[&SMALL[..], &dir, &["--in-process"]].concat(), &["process_per_epoch was true and is false", "--fresh"]);

    prints(&[&SMALL[..], &dir, &["--in-process", "--fresh"]].concat());
    let one = processes(folder.path());
    assert!(one.len() == 4 && one.iter().all(|process| *process == one[0]), "{one:?}");
}

/// What a process with a job says, given answers.
fn said(job: &Value) -> Vec<Value> {
    let job = format!("--case={job}");
    let mut command = command(&[&SMALL[..], &[&job]].concat());
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
fn a_process_measures_its_case_alone() {
    let folder = TempDir::new().unwrap();
    prints(&[&SMALL[..], &["--dir", folder.path().to_str().unwrap()]].concat());
    let cases = cases(folder.path());
    let [first, .., last] = &cases[..] else { panic!("{cases:?}") };
    assert_eq!((&first["case"]["scene"], &last["case"]["scene"]), (&"Cube".into(), &"Torus".into()));

    let job = |key: &Value| serde_json::json!({"study": "compare", "scene": "Torus", "key": key});
    let lines = said(&job(&last["key"]));
    let measured = &lines.last().unwrap()["Measured"];
    let answers = |case: &Value| {
        case["structures"].as_array().unwrap().iter().map(|s| s["rays"][0]["checksum"].clone()).collect::<Vec<_>>()
    };
    assert_eq!((&measured["epoch"], answers(measured)), (&1.into(), answers(&last["case"])));
    assert!(lines.iter().any(|line| line["Build"] == "sah-bvh"), "it says what it does: {lines:?}");

    // No other scene is loaded.
    let failed = said(&job(&first["key"]));
    let sentence = failed[0]["Failed"]["sentence"].as_str().unwrap();
    assert!(sentence.contains("Cube") && sentence.contains("plan it anew"), "{sentence}");
}
