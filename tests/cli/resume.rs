//! A study that is killed in the middle goes on where it stopped, and ends as one that was left alone.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::time::{Duration, Instant};

use serde_json::Value;

use super::command::command;

const EPOCHS: usize = 3;

/// A study of seconds, into the folder `dir`.
fn study(dir: &Path, rays: &str) -> Command {
    let mut command = command(&["study", "attribution", "cube", "--runs", "1", "--budget", "1", "--quiet"]);
    command.args(["--epochs", &EPOCHS.to_string(), "--rays", rays, "--dir"]).arg(dir);
    command.stdout(Stdio::piped()).stderr(Stdio::piped());
    command
}

fn finish(dir: &Path, rays: &str) -> Output {
    study(dir, rays).output().expect("the command runs")
}

/// The files of the journal, none where there is no journal.
fn files(dir: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(dir.join("attribution")).into_iter().flatten();
    let paths = entries.map(|entry| entry.unwrap().path());
    paths.filter(|path| path.extension().is_some_and(|ending| ending == "json")).collect()
}

/// Kills it as `kill -9` does, as soon as the journal has `wanted` cases.
fn kill_at(mut child: Child, dir: &Path, wanted: usize) {
    let start = Instant::now();
    while files(dir).len() < wanted {
        assert!(child.try_wait().unwrap().is_none(), "it ended before it could be killed");
        assert!(start.elapsed() < Duration::from_secs(600), "it measures nothing");
        std::thread::sleep(Duration::from_millis(2));
    }
    child.kill().unwrap();
    assert!(!child.wait().unwrap().success());
}

/// What no clock decides, of every case: by its key; a key that is there twice is found out.
fn counts(dir: &Path) -> BTreeMap<String, Value> {
    let mut cases = BTreeMap::new();
    for path in files(dir) {
        let mut file: Value = serde_json::from_slice(&fs::read(path).unwrap()).unwrap();
        for structure in file["case"]["structures"].as_array_mut().unwrap() {
            structure["build_ns"] = Value::Null;
            let rays = structure["rays"][0].as_object_mut().unwrap();
            let samples = rays.remove("ns").unwrap();
            rays.insert("samples".into(), samples.as_array().unwrap().len().into());
        }
        let key = file["key"].as_str().unwrap().to_owned();
        assert!(cases.insert(key.clone(), file["case"].take()).is_none(), "{key} is there twice");
    }
    cases
}

#[test]
fn a_killed_study_ends_as_one_that_was_left_alone() {
    let folder = tempfile::tempdir().unwrap();
    let (alone, killed) = (folder.path().join("alone"), folder.path().join("killed"));
    assert!(finish(&alone, "64").status.success());

    // Once with a case, and once with another one.
    kill_at(study(&killed, "64").spawn().unwrap(), &killed, 1);
    kill_at(study(&killed, "64").spawn().unwrap(), &killed, 2);
    // As if the power had failed while a case was written.
    fs::write(killed.join("attribution/.sahara-1234.part"), "{\"schema\":3,\"st").unwrap();
    let before = files(&killed).len();

    let output = finish(&killed, "64");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    assert!(before < files(&killed).len());
    assert_eq!(counts(&alone).len(), EPOCHS);
    assert_eq!(counts(&killed), counts(&alone));

    // A finished study is printed again and measures nothing.
    let times =
        || files(&killed).iter().map(|path| fs::metadata(path).unwrap().modified().unwrap()).collect::<Vec<_>>();
    let written = times();
    let again = finish(&killed, "64");
    assert_eq!(again.stdout, output.stdout);
    assert_eq!(times(), written);

    // Other settings are refused in one line.
    let refused = finish(&killed, "65");
    let message = String::from_utf8(refused.stderr).unwrap();
    assert_eq!((refused.status.code(), message.lines().count()), (Some(1), 1), "{message}");
    assert!(message.contains("rays was 64 and is 65") && message.contains("--fresh"), "{message}");
}
