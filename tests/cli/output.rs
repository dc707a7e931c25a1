//! Tests commands whose output cannot be written, and builders that panic.

use std::fs::File;
use std::process::Command;

use super::command::{Folder, NOT_BUILT, RIGHT, USAGE, WRONG, ends, output_texts};

fn status(command: &mut Command) -> i32 {
    let output = command.output().unwrap();
    let [_, messages] = output_texts(&output);
    assert!(!messages.contains("panicked"), "{command:?}: {messages}");
    output.status.code().unwrap_or_else(|| panic!("{command:?} is ended by a signal: {messages}"))
}

/// The builder of obvhs-cwbvh panics on the triangles in `huge.obj`.
fn huge() -> Folder {
    let (folder, mut text) = (Folder::new(), String::new());
    for corners in [
        [[-1e30, -1e30, 1.26765e30], [1e30, -1e30, 1.26765e30], [0.0, 2e30, 1.26765e30]],
        [[-1e30, -1e30, -1.26765e30], [1e30, -1e30, -1.26765e30], [0.0, 2e30, -1.26765e30]],
        [[1.26765e30, -1e30, -1e30], [1.26765e30, 1e30, -1e30], [1.26765e30, 0.0, 2e30]],
    ] {
        text.extend(corners.map(|[x, y, z]: [f32; 3]| format!("v {x:e} {y:e} {z:e}\n")));
        text += "f -3 -2 -1\n";
    }
    folder.write("huge.obj", text);
    folder
}

#[test]
fn a_verdict_outlives_the_reader_of_its_output() {
    let folder = huge();
    let full = || File::options().write(true).open("/dev/full").ok();
    for (line, expected) in [
        ("--help", RIGHT),
        ("list", RIGHT),
        ("render cube -o - --size 4x4", RIGHT),
        ("rays record cube -o - --rays 4", RIGHT),
        ("compare cube -s sah-kd --rays 64 --epochs 1", RIGHT),
        ("compare cube -s sah-kd --rays 64 --epochs 1 --export-json -", RIGHT),
        ("study accuracy cube -s sah-kd --rays 64 --in-process", RIGHT),
        (
            "validate cube -s sah-kd:test=moller-trumbore --against brute-force:test=exact --adversarial --rays 2000 --strict",
            WRONG,
        ),
        ("validate --hard cube_random -s sah-kd --rays 64", RIGHT),
        ("validate huge.obj -s obvhs-cwbvh --rays 10", NOT_BUILT),
        ("compare sponsa", USAGE),
    ] {
        // The reader closes before the command starts.
        let (reader, writer) = std::io::pipe().unwrap();
        drop(reader);
        assert_eq!(status(folder.command(line).stdout(writer)), expected, "{line} without a reader");
        if let Some(full) = full() {
            assert_eq!(status(folder.command(line).stdout(full)), expected.max(USAGE), "{line} on a full disk");
        }
    }
    for (line, expected) in [("compare cube -s sah-kd --quick", RIGHT), ("compare sponsa", USAGE)] {
        let Some(full) = full() else { continue };
        assert_eq!(status(folder.command(line).stderr(full)), expected, "{line} with messages to a full disk");
    }
}

#[test]
fn a_builder_that_panics_is_a_sentence_and_no_backtrace() {
    let folder = huge();
    let run = |line: &str, status| ends(status, folder.command(line).env("RUST_BACKTRACE", "1"));
    for command in ["validate", "compare"] {
        let line = format!("--quiet {command} huge.obj -s obvhs-cwbvh -s sah-kd --rays 10");
        let [text, message] = run(&line, NOT_BUILT);
        assert_eq!(message, "", "{command}");
        assert_eq!(text.matches("its builder panicked on this mesh").count(), 1, "{text}");
    }
    let [_, message] = run("render huge.obj -s obvhs-cwbvh -o x.png", USAGE);
    assert!(message.lines().count() == 1 && message.contains("its builder panicked"), "{message}");
}
