//! `sahara compare --runner`: other programs, good and bad ones.

use std::fs;
use std::path::Path;
use std::process::Command;

use serde_json::Value;
use tempfile::TempDir;

use super::command::{
    NOT_BUILT, RIGHT, WRONG, at, command, ends, path_text, prints, program, refuses_in_a_line, sahara, stderr,
    unwrapped, words, write,
};

const EXAMPLE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/runner/brute_force.cpp");

/// Compiles the example with a changed text; `None` without a compiler.
fn compiled(folder: &TempDir, name: &str, change: impl Fn(String) -> String) -> Option<String> {
    if Command::new("c++").arg("--version").output().is_err() {
        println!("skipped: there is no C++ compiler, `c++`, here");
        return None;
    }
    let (source, program) = (folder.path().join(format!("{name}.cpp")), folder.path().join(name));
    fs::write(&source, change(fs::read_to_string(EXAMPLE).unwrap())).unwrap();
    let flags = ["-std=c++17", "-O2", "-Wall", "-Werror", "-o"];
    let output = Command::new("c++").args(flags).args([&program, &source]).output().unwrap();
    assert!(output.status.success(), "{}", stderr(&output));
    Some(path_text(&program))
}

const SMALL: [&str; 13] =
    ["compare", "cube", "-s", "sah-kd", "-w", "primary", "-w", "shadow", "--rays", "400", "--epochs", "2", "--runner"];

/// The outputs in one line, and the rows of a run, which must end with this status.
#[track_caller]
fn records(folder: &TempDir, args: &[&str], status: i32) -> (String, Vec<Value>) {
    let file = at(folder, "r.json");
    let (text, messages) = ends(status, &mut command(&[args, &["--export-json", &file]].concat()));
    (unwrapped(&(text + &messages)), super::journal::rows(file))
}

#[test]
fn the_example_of_the_document_is_timed_beside_ours() {
    let folder = TempDir::new().unwrap();
    let Some(program) = compiled(&folder, "brute_force", |text| text) else { return };
    let lines = fs::read_to_string(EXAMPLE).unwrap().lines().count();
    let document = include_str!("../../src/images/scene/files/FORMAT.md");
    assert!(lines <= 71 && document.contains("tests/runner/brute_force.cpp") && document.contains("70 lines"));

    let with_argument = format!("'{program}' --any-argument");
    let (text, records) = records(&folder, &[&SMALL[..], &[&with_argument]].concat(), RIGHT);
    assert!(text.contains("brute_force --any-argument (own clock)"), "{text}");
    let (ours, theirs) = records.split_at(records.len() / 2);
    assert_eq!((theirs.len(), &theirs[0]["name"]), (2, &"runner".into()), "{text}");
    for (ours, theirs) in ours.iter().zip(theirs) {
        assert_eq!((&theirs["checked"]["errors"], &theirs["config"]["clock"]), (&0.into(), &"own".into()), "{theirs}");
        assert!(theirs["checked"]["rays"].as_u64() >= Some(64) && theirs["ns"][0].as_u64() > Some(0), "{theirs}");
        assert!(theirs["shape"]["bytes"].as_u64() > Some(0) && theirs["counts"]["tests"].is_null(), "{theirs}");
        for same in ["hash", "all", "query"] {
            assert_eq!(ours[same], theirs[same]);
        }
        // Their samples are from the same rounds, and hardly any ray hits by one test and not by the other.
        assert!(theirs["ns"].as_array().unwrap().len() == ours["ns"].as_array().unwrap().len(), "{theirs}");
        let hits = |record: &Value| record["counts"]["hits"].as_f64().unwrap();
        assert!((hits(ours) - hits(theirs)).abs() <= 0.001 * hits(ours), "{ours} {theirs}");
    }
    // It misses the rays that are not valid, as the document demands.
    let invalid = ["validate", "--hard", "rays_nan_dir", "rays_inf_dir", "--rays", "50", "--runner", &program];
    assert!(prints(&invalid).contains("brute_force is right on 100 rays"));
}

#[test]
fn wrong_hits_of_a_program_cost_it_all_its_times_and_nobody_else() {
    let folder = TempDir::new().unwrap();
    let Some(program) = compiled(&folder, "loses", |text| text.replace("u >= 0 &&", "u >= 0.5 &&")) else { return };
    let (text, records) = records(&folder, &[&SMALL[..], &[&program]].concat(), WRONG);
    assert!(text.contains("loses (own clock)") && text.contains(" wrong"), "{text}");
    // A single cube throws no shadow on itself: those rays are right, but a wrong tree has no time.
    let timed: Vec<bool> = records.iter().map(|record| !record["ns"].as_array().unwrap().is_empty()).collect();
    assert_eq!(timed, [true, true, false, false], "{text}");
    assert!(records[2]["checked"]["errors"].as_u64() > Some(0), "{text}");
}

/// Returns a miss for every ray, and misbehaves in the way of its argument.
pub const NOTHING: &str = include_str!("../runner/nothing.sh");

pub fn nothing(folder: &TempDir) -> String {
    program(folder, "nothing.sh", NOTHING)
}

#[test]
fn a_program_that_fails_is_refused_in_a_sentence_and_the_others_go_on() {
    let folder = TempDir::new().unwrap();
    let program = nothing(&folder);
    let failures = [
        ("unbuilt", "it ended instead of replying to \"scene "),
        ("refuses", "it reports the error: it holds no more than two triangles"),
        ("dies", "(exit status: 3)"),
        ("hangs", "it does not reply to \"pass 0\" within 5 s"),
        ("nan", "it replies \"passed nan\" to \"pass 0\", not \"passed SECONDS\""),
        ("backwards", "it replies \"passed -1\""),
        ("chatters", "\"that was quick\""),
        ("floods", "\"that was much\""),
        ("few", "its hits cannot be read: "),
    ];
    let commands: Vec<String> = failures.iter().map(|(how, _)| format!("{program} {how}")).collect();
    let runners: Vec<&str> = commands.iter().flat_map(|command| ["--runner", command]).collect();
    let small = ["compare", "cube", "-s", "sah-kd", "-w", "primary", "--rays", "256", "--epochs", "2"];
    let args = [&small[..], &["--runner-limit", "5"], &runners].concat();
    let (text, records) = records(&folder, &args, NOT_BUILT);
    assert!(!text.contains("panicked"), "{text}");
    for (how, sentence) in failures {
        let label = format!("nothing.sh {how} (own clock): ");
        let said = text.split(&label).nth(1).unwrap_or_else(|| panic!("{label} in {text}"));
        let said = &said[..said.len().min(400)];
        assert!(said.contains(sentence), "{how}: {said}");
    }
    assert_eq!(records.len(), 1, "{text}");
    assert_eq!(records[0]["label"], "sah-kd");
    assert!(records[0]["ns"][0].as_u64() > Some(0), "{text}");
}

#[test]
fn a_program_that_fails_is_not_checked_and_not_wrong() {
    let folder = TempDir::new().unwrap();
    let program = nothing(&folder);
    let scene = ["cube", "--rays", "8"];
    let cases = ["--hard", "flat_inplane", "parity", "straight_down", "--rays", "8"];
    for (how, sentence) in [
        ("refuses", "it reports the error: it holds no more than two triangles."),
        ("objects", "it reports the error: no ray fits."),
        ("miscounts", "it replies \"loaded 7\" to \"rays 0 "),
        ("dies", "it ended instead of replying to \"pass 0\" (exit status: 3)."),
        ("hangs", "it does not reply to \"pass 0\" within 0.5 s: raise --runner-limit."),
    ] {
        let runner = format!("{program} {how}");
        for what in [&scene[..], &cases] {
            let args = [&["validate", "--runner", &runner, "--runner-limit", "0.5"], what].concat();
            let (said, _) = ends(NOT_BUILT, &mut command(&args));
            let last = said.split("was not checked: ").nth(1).unwrap_or_else(|| panic!("{args:?}: {said}"));
            assert!(last.starts_with(sentence) && !last.contains("write messages"), "{args:?}: {said}");
        }
    }
}

#[test]
fn a_slow_program_has_time_for_each_reply() {
    let folder = TempDir::new().unwrap();
    // All its passes together take longer than any of the limits.
    let slow = format!("{} slow", nothing(&folder));
    let limits = ["--limit", "0.5", "--runner-limit", "1"];
    let hard = ["validate", "--hard", "flat_inplane", "--rays", "16", "--runner", &slow];
    let said = prints(&[&hard[..], &limits].concat());
    assert!(said.contains("is right on 16 rays"), "{said}");
}

#[test]
fn a_clock_that_disagrees_with_ours_is_told_and_what_it_declines_is_not_asked() {
    let folder = TempDir::new().unwrap();
    let program = nothing(&folder);
    let rays = at(&folder, "away.rays");
    let text = write(&folder, "away.txt", &"9,9,9 0,0,1\n".repeat(100));
    for (how, any, part) in
        [("liar", None, "times as long as it reports"), ("honest", Some("--any"), "declines any hit")]
    {
        let import = ["rays", "import", &text, "-o", &rays, "--scene", "cube"];
        prints(&import.into_iter().chain(any).collect::<Vec<_>>());
        let own = ["--rays", &rays, "--runner", &format!("{program} {how}")];
        let args = [&words("compare -s sah-kd --epochs 2 --runs 2 --verbose")[..], &own].concat();
        let (text, records) = records(&folder, &args, RIGHT);
        assert_eq!(records.len(), 2, "{text}");
        assert!(text.contains(&format!("nothing.sh {how} (own clock)")) && text.contains(part), "{text}");
        assert_eq!(records[1]["ns"].as_array().unwrap().is_empty(), any.is_some(), "{text}");
    }
}

#[test]
fn what_is_no_runner_is_refused_before_anything_is_measured() {
    for (command, parts) in [
        ("./no-such-program -x", &["./no-such-program -x", "the program \"./no-such-program\" cannot be started"][..]),
        (
            "my bvh=./bvh",
            &["the program \"my\" cannot be started", "\"my bvh\", before the first \"=\", is not a valid NAME"],
        ),
        ("=./bvh", &["the program \"=./bvh\" cannot be started", "\"\", before the first \"=\", is not a valid NAME"]),
        ("my=bvh=./bvh", &["the program \"bvh=./bvh\" cannot be started"]),
        ("true", &["\"true\"", "it ended instead of replying to \"sahara 1 1\""]),
        ("cat", &["it replies \"sahara 1 1\"", "runner 1 closest any"]),
        ("yes", &["\"yes\"", "\"y\"", "\"sahara 1 1\""]),
        ("'open", &["quote arguments"]),
        ("", &["quote arguments"]),
    ] {
        refuses_in_a_line(&["compare", "cube", "--runner", command], parts);
    }
    let folder = TempDir::new().unwrap();
    let (one, other) = (nothing(&folder), program(&folder, "b/nothing.sh", NOTHING));
    let suites = format!("SAH-kd={one}");
    for command in ["compare", "validate"] {
        let both = [command, "cube", "--runner", &one, "--runner", &other];
        refuses_in_a_line(&both, &["another runner share the name nothing.sh: rename the runner with NAME=COMMAND"]);
        let named = [command, "cube", "--runner", &suites];
        refuses_in_a_line(&named, &["another structure share the name SAH-kd: rename"]);
    }
}

#[test]
fn another_build_of_a_program_is_another_structure() {
    let folder = TempDir::new().unwrap();
    let program = nothing(&folder);
    let dir = at(&folder, "runs");
    let own = words("compare cube -s sah-kd -w primary --rays 256 --epochs 1 --budget 1 --runner");
    // With any status: a program that finds nothing is wrong.
    let run = || sahara(&[&own[..], &[&program, "--dir", &dir]].concat());
    let cases = || super::journal::cases(Path::new(&dir), "compare").len();
    run();
    run();
    assert_eq!(cases(), 1);
    write(&folder, "nothing.sh", &(NOTHING.to_owned() + "# rebuilt\n"));
    run();
    assert_eq!(cases(), 2);
}
