//! Each epoch of a scene is measured in a process of its own.

use std::io::Write;
use std::process::Stdio;

use serde_json::Value;
use tempfile::TempDir;

use super::command::{command, prints, stderr};

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
        prints(&[&SMALL[..], &["--budget", "1", "--export-json", file.to_str().unwrap()], more].concat());
        answers(&std::fs::read(file).unwrap())
    };
    let apart = run("apart.json", &[]);
    assert_eq!(apart.len(), 4);
    assert_eq!(apart, run("one.json", &["--in-process"]));
}

/// The lines that a process with a job says, given the first epoch.
fn said(job: &Value, first: &Value) -> Vec<Value> {
    let job = format!("--case={job}");
    let mut command = command(&[&SMALL[..], &[&job]].concat());
    let mut child = command.stdin(Stdio::piped()).stdout(Stdio::piped()).spawn().unwrap();
    child.stdin.take().unwrap().write_all(first.to_string().as_bytes()).unwrap();
    let output = child.wait_with_output().unwrap();
    assert!(output.status.success(), "{}", stderr(&output));
    output
        .stdout
        .split(|&byte| byte == b'\n')
        .filter(|line| !line.is_empty())
        .map(|line| serde_json::from_slice(line).unwrap())
        .collect()
}

#[test]
fn a_process_measures_its_case_alone() {
    let folder = TempDir::new().unwrap();
    prints(&[&SMALL[..], &["--dir", folder.path().to_str().unwrap()]].concat());
    let journal = std::fs::read_to_string(folder.path().join("compare.jsonl")).unwrap();
    let cases: Vec<Value> = journal.lines().skip(1).map(|line| serde_json::from_str(line).unwrap()).collect();
    let [first, .., last] = &cases[..] else { panic!("{journal}") };
    let of_torus = cases.iter().find(|case| case["case"]["scene"] == "Torus").unwrap();
    assert_eq!((&first["case"]["scene"], &last["case"]["scene"]), (&"Cube".into(), &"Torus".into()));

    let job = |key: &Value| serde_json::json!({"study": "compare", "scene": "Torus", "key": key});
    let lines = said(&job(&last["key"]), &of_torus["case"]);
    let measured = &lines.last().unwrap()["Measured"];
    let answers = |case: &Value| {
        case["structures"].as_array().unwrap().iter().map(|s| s["rays"][0]["checksum"].clone()).collect::<Vec<_>>()
    };
    assert_eq!((&measured["epoch"], answers(measured)), (&1.into(), answers(&last["case"])));
    assert!(lines.iter().any(|line| line["Build"] == "sah-bvh"), "it says what it does: {lines:?}");

    // No other scene is loaded.
    let failed = said(&job(&first["key"]), &Value::Null);
    let sentence = failed[0]["Failed"]["sentence"].as_str().unwrap();
    assert!(sentence.contains("Torus") && sentence.contains("start anew"), "{sentence}");
}
