//! Tests `--runner` with correct and faulty programs.

use std::fs;
use std::process::Command;

use serde_json::Value;

use super::command::{Folder, NOT_BUILT, RIGHT, WRONG, assert_contains, ends, unwrapped};
use super::journal::{cases, rows};

const EXAMPLE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/runner/brute_force.cpp");

/// Returns `None` if the compiler `c++` is missing.
fn compiled(name: &str, change: impl Fn(String) -> String) -> Option<Folder> {
    if Command::new("c++").arg("--version").output().is_err() {
        println!("skipped: there is no C++ compiler, `c++`, here");
        return None;
    }
    let (folder, source) = (Folder::new(), format!("{name}.cpp"));
    folder.write(&source, change(fs::read_to_string(EXAMPLE).unwrap()));
    let mut compiler = Command::new("c++");
    compiler.args(["-std=c++17", "-O2", "-Wall", "-Werror", "-o", name, &source]).current_dir(folder.path(""));
    ends(RIGHT, &mut compiler);
    Some(folder)
}

const SMALL: &str = "compare cube -s sah-kd -w primary -w shadow --rays 400 --epochs 2 --runner";

/// Returns the printed text on one line, and the rows of the export.
#[track_caller]
fn records(folder: &Folder, line: &str, status: i32) -> (String, Vec<Value>) {
    let text = folder.ends(status, &format!("{line} --export-json r.json")).concat();
    (unwrapped(&text), rows(folder.path("r.json")))
}

#[test]
fn the_example_of_the_document_is_timed_beside_ours() {
    let Some(folder) = compiled("brute_force", |text| text) else { return };
    let lines = fs::read_to_string(EXAMPLE).unwrap().lines().count();
    let document = include_str!("../../src/images/scene/files/FORMAT.md");
    assert!(lines <= 71 && document.contains("tests/runner/brute_force.cpp") && document.contains("70 lines"));

    let (text, records) = records(&folder, &format!("{SMALL} './brute_force --any-argument'"), RIGHT);
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
        assert!(theirs["ns"].as_array().unwrap().len() == ours["ns"].as_array().unwrap().len(), "{theirs}");
        // The triangle tests of the structure and the runner may disagree on a few rays.
        let hits = |record: &Value| record["counts"]["hits"].as_f64().unwrap();
        assert!((hits(ours) - hits(theirs)).abs() <= 0.001 * hits(ours), "{ours} {theirs}");
    }
    // The example returns a miss for every invalid ray.
    folder.shows(
        "validate --hard rays_nan_dir rays_inf_dir --rays 50 --runner ./brute_force",
        &["brute_force is right on 100 rays"],
    );
}

#[test]
fn wrong_hits_of_a_program_cost_it_all_its_times_and_nobody_else() {
    let Some(folder) = compiled("loses", |text| text.replace("u >= 0 &&", "u >= 0.5 &&")) else { return };
    let (text, records) = records(&folder, &format!("{SMALL} ./loses"), WRONG);
    assert!(text.contains("loses (own clock)") && text.contains(" wrong"), "{text}");
    // Wrong primary hits also remove the times of the shadow rays.
    let timed: Vec<bool> = records.iter().map(|record| !record["ns"].as_array().unwrap().is_empty()).collect();
    assert_eq!(timed, [true, true, false, false], "{text}");
    assert!(records[2]["checked"]["errors"].as_u64() > Some(0), "{text}");
}

/// A runner that returns a miss for every ray. Its argument selects a fault.
pub const NOTHING: &str = include_str!("../runner/nothing.sh");

fn nothing() -> Folder {
    let folder = Folder::new();
    folder.program("nothing.sh", NOTHING);
    folder
}

#[test]
fn a_program_that_fails_is_refused_in_a_sentence_and_the_others_go_on() {
    let failures = [
        ("unbuilt", "it ended instead of replying to \"scene "),
        ("refuses", "it reports the error: it holds no more than two triangles"),
        ("dies", "(exit status: 3)"),
        ("hangs", "it does not reply to \"pass 0\" within 2 s"),
        ("nan", "it replies \"passed nan\" to \"pass 0\", not \"passed SECONDS\""),
        ("backwards", "it replies \"passed -1\""),
        ("chatters", "\"that was quick\""),
        ("floods", "\"that was much\""),
        ("few", "its hits cannot be read: "),
    ];
    let runners: String = failures.iter().map(|(how, _)| format!(" --runner './nothing.sh {how}'")).collect();
    let small = "compare cube -s sah-kd -w primary --rays 256 --epochs 2 --runner-limit 2";
    let (text, records) = records(&nothing(), &format!("{small}{runners}"), NOT_BUILT);
    assert!(!text.contains("panicked"), "{text}");
    for (how, sentence) in failures {
        let label = format!("nothing.sh {how} (own clock): ");
        let reason = text.split(&label).nth(1).unwrap_or_else(|| panic!("{label} in {text}"));
        let reason = &reason[..reason.len().min(400)];
        assert!(reason.contains(sentence), "{how}: {reason}");
    }
    assert!(records.len() == 1 && records[0]["label"] == "sah-kd", "{text}");
    assert!(records[0]["ns"][0].as_u64() > Some(0), "{text}");
}

#[test]
fn a_program_that_fails_is_not_checked_and_not_wrong() {
    let folder = nothing();
    for (how, sentence) in [
        ("refuses", "it reports the error: it holds no more than two triangles."),
        ("objects", "it reports the error: no ray fits."),
        ("miscounts", "it replies \"loaded 7\" to \"rays 0 "),
        ("dies", "it ended instead of replying to \"pass 0\" (exit status: 3)."),
        ("hangs", "it does not reply to \"pass 0\" within 0.5 s: raise --runner-limit."),
    ] {
        for what in ["cube", "--hard flat_inplane parity straight_down"] {
            let line = format!("validate --runner './nothing.sh {how}' --runner-limit 0.5 {what} --rays 8");
            let [text, _] = folder.ends(NOT_BUILT, &line);
            let last = text.split("was not checked: ").nth(1).unwrap_or_else(|| panic!("{line}: {text}"));
            assert!(last.starts_with(sentence) && !last.contains("write messages"), "{line}: {text}");
        }
    }
}

#[test]
fn a_slow_program_has_time_for_each_reply() {
    // All passes of the program together take longer than each of the limits.
    let slow = "--runner './nothing.sh slow' --limit 0.5 --runner-limit 1";
    nothing().shows(&format!("validate --hard flat_inplane --rays 16 {slow}"), &["is right on 16 rays"]);
}

#[test]
fn a_clock_that_disagrees_with_ours_is_told_and_what_it_declines_is_not_asked() {
    let folder = nothing();
    folder.write("away.txt", "9,9,9 0,0,1\n".repeat(100));
    for (how, any, part) in [("liar", "", "times as long as it reports"), ("honest", "--any", "declines any hit")] {
        folder.prints(&format!("rays import away.txt -o away.rays --scene cube {any}"));
        let small = "compare -s sah-kd --epochs 2 --runs 2 --verbose --rays away.rays";
        let (text, records) = records(&folder, &format!("{small} --runner './nothing.sh {how}'"), RIGHT);
        assert_eq!(records.len(), 2, "{text}");
        assert_contains(&text, &[&format!("nothing.sh {how} (own clock)"), part]);
        assert_eq!(records[1]["ns"].as_array().unwrap().is_empty(), !any.is_empty(), "{text}");
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
        Folder::new().refuses_in_a_line(&format!("compare cube --runner \"{command}\""), parts);
    }
    let folder = nothing();
    folder.program("b/nothing.sh", NOTHING);
    for (runners, part) in [
        (
            "--runner ./nothing.sh --runner b/nothing.sh",
            "another runner share the name nothing.sh: rename the runner with NAME=COMMAND",
        ),
        ("--runner SAH-kd=./nothing.sh", "another structure share the name SAH-kd: rename"),
    ] {
        for command in ["compare", "validate"] {
            folder.refuses_in_a_line(&format!("{command} cube {runners}"), &[part]);
        }
    }
}

#[test]
fn another_build_of_a_program_is_another_structure() {
    let folder = nothing();
    let own = "compare cube -s sah-kd -w primary --rays 256 --epochs 1 --budget 1 --runner ./nothing.sh --dir runs";
    let measured = || {
        folder.ends(WRONG, own);
        cases(&folder.path("runs"), "compare").len()
    };
    assert_eq!([measured(), measured()], [1; 2]);
    folder.write("nothing.sh", NOTHING.to_owned() + "# rebuilt\n");
    assert_eq!(measured(), 2);
}
