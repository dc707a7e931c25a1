//! Tests the files and processes of studies with several epochs.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use super::command::{Folder, RIGHT, ends, json};
use super::journal::{answers, cases};

#[test]
fn a_study_goes_on_where_it_stopped_and_repeats_what_it_said() {
    for (name, study) in [
        ("scaling", "study scaling cube --finest 2 -s median-kd -s sah-bvh"),
        ("compare", "compare cube torus -s median-kd -s sah-kd"),
    ] {
        let folder = Folder::new();
        let cases = || cases(&folder.path(""), name);
        let run = |options: &str| {
            let small = "-w primary --rays 64 --runs 1 --budget 1 --dir . --epochs";
            (folder.prints(&format!("{study} {small} {options}")), cases().len())
        };
        let (first, measured) = run("1");
        assert!(measured > 0, "{study}");
        assert_eq!(run("1"), (first, measured), "{study} measures nothing again");
        // A second epoch doubles the number of cases.
        assert_eq!(run("2").1, 2 * measured, "{study}");
        // A removed case is measured again.
        fs::remove_file(&cases()[0]).unwrap();
        assert_eq!(run("2").1, 2 * measured, "{study}");
        // Another seed and `--fresh` add cases.
        assert_eq!(run("1 --seed 2").1, 3 * measured, "{study}");
        assert_eq!(run("1 --fresh").1, 4 * measured, "{study}");
    }
}

/// A study that takes some seconds.
fn study(folder: &Folder, dir: &str) -> Command {
    let small = "study attribution cube --rays 64 --runs 1 --budget 1 --epochs 6 --quiet --dir";
    let mut command = folder.command(&format!("{small} {dir}"));
    command.stdout(Stdio::piped()).stderr(Stdio::piped());
    command
}

/// Kills the process as soon as the journal in `dir` has `wanted` cases.
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
    let folder = Folder::new();
    ends(RIGHT, &mut study(&folder, "alone"));
    let [alone, killed] = ["alone", "killed"].map(|name| folder.path(name));

    for wanted in [1, 2] {
        kill_at(study(&folder, "killed").spawn().unwrap(), &killed, wanted);
    }
    // Simulate a power failure while a case is written.
    folder.write("killed/attribution/.sahara-1234.part", "{\"schema\":4,\"pr");
    let before = cases(&killed, "attribution").len();

    ends(RIGHT, &mut study(&folder, "killed"));
    assert!(before < cases(&killed, "attribution").len());
    assert_eq!(answers(&alone, "attribution").len(), 6);
    assert_eq!(answers(&killed, "attribution"), answers(&alone, "attribution"));
}

const TWO_SCENES: &str = "compare cube torus -s sah-kd -s sah-bvh -w diffuse --rays 256 --epochs 2 --dir";

#[test]
fn each_epoch_of_a_scene_has_a_process_and_one_process_answers_the_same() {
    let folder = Folder::new();
    let [apart, one] = ["apart", "one"].map(|name| folder.path(name));
    let processes = |dir: &Path| -> BTreeSet<u64> {
        let process = |path| json(path)["epoch"]["environment"]["process"].as_u64().unwrap();
        cases(dir, "compare").iter().map(process).collect()
    };
    folder.prints(&format!("{TWO_SCENES} apart"));
    folder.prints(&format!("{TWO_SCENES} one --in-process"));
    assert_eq!((processes(&apart).len(), processes(&one).len()), (4, 1), "two epochs of two scenes");
    assert_eq!(answers(&apart, "compare"), answers(&one, "compare"));
    // The journal keeps the cases with and without `--in-process`.
    folder.prints(&format!("{TWO_SCENES} apart --in-process"));
    assert_eq!(cases(&apart, "compare").len(), 8);
}
