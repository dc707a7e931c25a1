//! `sahara study`: its output, exports and figures.

use std::fs;

use serde_json::Value;

use super::command::{at, command, json, prints, refused_in_a_line, sahara, small, stderr, words};
use super::journal;

#[test]
fn accuracy_prints_exports_and_draws_what_it_finds() {
    let directory = tempfile::tempdir().unwrap();
    let [export, svg, dir] = ["a.json", "a.svg", "runs"].map(|name| at(&directory, name));
    let small = "study accuracy cube --rays 300 --runs 2 --budget 1 --workload vertex --workload uniform";
    let over = "-s sah-kd -t exact -t moller-trumbore";
    let files = format!("--export-json {export} --plot {svg} --dir {dir}");
    let printed = prints(&words(&format!("{small} {over} {files}")));
    for text in [
        "vertex: 300 rays through vertices",
        "uniform: 300 camera rays and random lines",
        ":test=moller-trumbore",
        "dominated by",
    ] {
        assert!(printed.contains(text), "{text} is not in {printed}");
    }
    let rows = journal::rows(&export);
    assert_eq!(rows.len(), 4, "{rows:?}");
    let wrong = |row: &Value| ["missed", "false_hits", "wrong_depth"].map(|kind| row["errors"][kind].as_u64().unwrap());
    let exact: Vec<&Value> = rows.iter().filter(|row| row["triangle_test"] == "exact").collect();
    assert_eq!(exact.len(), 2);
    assert!(exact.iter().all(|row| wrong(row) == [0; 3] && row["errors"]["rays"] == 300), "{rows:?}");
    // A process has measured them, and the dataset names the run.
    let provenance = &json(&export)["provenance"];
    assert_eq!(provenance["process_per_epoch"], true);
    assert!(!provenance["command"].as_str().unwrap().contains("--case"), "{provenance}");
    assert!(fs::read_to_string(svg).unwrap().contains("moller-trumbore"));
}

#[test]
fn more_threads_than_cores_are_warned_of() {
    let cores = std::thread::available_parallelism().unwrap().get();
    let told = |threads: usize| {
        let threads = threads.to_string();
        stderr(&sahara(&[&small("cube")[..], &["-s", "sah-kd", "--epochs", "1", "--threads", &threads]].concat()))
    };
    assert!(told(cores + 1).contains(&format!("warning: {} threads share {cores} core", cores + 1)));
    assert!(!told(cores).contains("threads share"));
}

#[test]
fn real_meshes_that_are_asked_for_are_never_replaced() {
    let empty = tempfile::tempdir().unwrap();
    let args = ["--quiet", "study", "attribution", "cube", "dragon", "--meshes", "real"];
    let output = command(&args).env("SAHARA_DATA", empty.path()).output().unwrap();
    refused_in_a_line(&output, &["real meshes of Dragon are missing: `sahara fetch`"]);
}

/// A limit of the address space acts as a limit of threads.
#[test]
#[cfg(target_os = "linux")]
fn more_threads_than_the_system_gives_are_refused_before_anything_is_measured() {
    let folder = tempfile::tempdir().unwrap();
    for words in ["study attribution cube --threads 1024", "compare cube --threads 1024"] {
        // Eight and a half gigabytes of addresses, and one for the stack of each thread: the system refuses a stack,
        // which leaves more than everything else requires. A thread that fails while it starts would end the process.
        let script = format!("ulimit -v 8300000; exec {} -q {words}", env!("CARGO_BIN_EXE_sahara"));
        let mut command = std::process::Command::new("sh");
        command.env("RUST_MIN_STACK", "1000000000").env("RAYON_NUM_THREADS", "1").env("MALLOC_ARENA_MAX", "1");
        let output = command.args(["-c", &script]).current_dir(folder.path()).output().unwrap();
        refused_in_a_line(&output, &["error: the system cannot start 1024 threads", "lower --threads"]);
    }
    assert!(journal::cases(&folder.path().join("runs"), "compare").is_empty());
}
