//! `sahara study`: what is printed, exported and drawn.

use std::fs;
use std::path::Path;

use sahara::render::Picture;

use super::command::{
    command, json, path_text, prints, refused_in_a_line, refuses_in_a_line, sahara, small, stderr, words,
};

#[test]
fn accuracy_prints_exports_and_draws_what_it_finds() {
    let directory = tempfile::tempdir().unwrap();
    let file = |name: &str| path_text(&directory.path().join(name));
    let (export, svg, png) = (file("a.json"), file("a.svg"), file("a.png"));
    let small = "study accuracy cube --rays 300 --runs 2 --budget 1 --workload vertex --workload uniform";
    let over = "-s sah-kd -t exact -t moller-trumbore";
    let dir = file("runs");
    let files = ["--export-json", &export, "--plot", &svg, "--plot", &png, "--dir", &dir];
    let printed = prints(&[words(small), words(over), files.into()].concat());
    for text in
        ["vertex: 300 rays through vertices", "uniform: 300 rays", "sah-kd:test=moller-trumbore", "dominated by"]
    {
        assert!(printed.contains(text), "{text} is not in {printed}");
    }
    let export = json(&export);
    let records = &export["result"];
    assert_eq!((&export["study"], records.as_array().unwrap().len()), (&"accuracy".into(), 4));
    let exact = records.as_array().unwrap().iter().filter(|record| record["triangle_test"] == "exact");
    // No error in 300 rays: with less than 1 - 0.05^(1/300) of errors that happens in more than 5 % of cases.
    let bounded = |record: &serde_json::Value| (record["error_bound"].as_f64().unwrap() - 0.009_936).abs() < 1e-6;
    assert!(exact.clone().all(|record| record["error"] == 0.0 && bounded(record)), "{records}");
    assert_eq!(exact.count(), 2);
    // A process has measured them, and each names the run.
    let of_run = |record: &serde_json::Value| {
        let provenance = &record["provenance"];
        provenance["process_per_epoch"] == true && !provenance["command"].as_str().unwrap().contains("--case")
    };
    assert!(records.as_array().unwrap().iter().all(of_run), "{records}");
    assert!(fs::read_to_string(svg).unwrap().contains("moller-trumbore"));
    assert_eq!(Picture::read(Path::new(&png)).unwrap().size()[0], 1600);
}

#[test]
fn a_study_prints_its_table_and_writes_its_cases() {
    let directory = tempfile::tempdir().unwrap();
    let export = path_text(&directory.path().join("s.json"));
    let few = ["study", "self-intersection", "--rays", "20", "-s", "sah-kd", "-s", "brute-force"];
    let printed = prints(&[&few[..], &["--export-json", &export]].concat());
    assert!(printed.contains("waechter-binder") && printed.contains("r=10 @1e5"), "{printed}");

    let study = json(&export);
    let rows = study["result"].as_array().unwrap();
    assert_eq!(rows.len(), 6 * 2 * 2 * 5);
    let bounded = |row: &&serde_json::Value| row["offset"] == "error-bounded" && row["point"] == "corners";
    let mut bounded = rows.iter().filter(bounded);
    assert!(bounded.all(|row| row["outward"] == 20 && row["acne"] == 0 && row["leaks"] == 0), "{rows:?}");
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
    let args = ["--quiet", "study", "break-even", "cube", "dragon", "--meshes", "real"];
    let output = command(&args).env("SAHARA_DATA", empty.path()).output().unwrap();
    refused_in_a_line(&output, &["real meshes of Dragon are not there: `sahara fetch`"]);
}

#[test]
fn a_picture_that_there_is_not_is_refused_before_anything_is_measured() {
    let directory = tempfile::tempdir().unwrap();
    let (dir, svg) = (path_text(&directory.path().join("runs")), path_text(&directory.path().join("a.svg")));
    let few = ["study", "self-intersection", "--rays", "20", "--plot", &svg, "--dir", &dir];
    refuses_in_a_line(&few, &["no picture", "--plot"]);
    assert!(!Path::new(&dir).exists() && !Path::new(&svg).exists());
}

#[test]
fn two_results_are_not_written_to_one_place() {
    let directory = tempfile::tempdir().unwrap();
    let [one, again] = ["a.json", "./a.json"].map(|name| format!("{}/{name}", path_text(directory.path())));
    let twice = ["study", "self-intersection", "--rays", "20", "--export-json", &one, "--export-csv", &again];
    refuses_in_a_line(&twice, &["two results", "a.json"]);
}

/// A limit of the memory that may be addressed stands for one of the threads.
#[test]
#[cfg(target_os = "linux")]
fn more_threads_than_the_system_gives_are_refused_before_anything_is_measured() {
    let folder = tempfile::tempdir().unwrap();
    for words in ["study threads cube --most 1024", "study counts cube --threads 1024"] {
        // Eight and a half gigabytes of addresses, and one for the stack of each thread: what is refused is a stack, which
        // leaves more than all else asks for. A thread that fails while it starts would end the process.
        let script = format!("ulimit -v 8300000; exec {} -q {words}", env!("CARGO_BIN_EXE_sahara"));
        let mut command = std::process::Command::new("sh");
        command.env("RUST_MIN_STACK", "1000000000").env("RAYON_NUM_THREADS", "1").env("MALLOC_ARENA_MAX", "1");
        let output = command.args(["-c", &script]).current_dir(folder.path()).output().unwrap();
        refused_in_a_line(&output, &["error: the system does not give 1024 threads", "ask for fewer"]);
    }
    assert!(super::journal::cases(&folder.path().join("runs"), "threads").is_empty());
}
