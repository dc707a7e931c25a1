//! The verdict if its output cannot be written, and output that is never printed.

use std::fs::File;
use std::process::Stdio;

use super::command::{NOT_BUILT, RIGHT, USAGE, WRONG, at, command, ends, stderr, words, write};

/// The status with this standard output.
fn status(line: &str, out: impl Into<Stdio>) -> i32 {
    let output = command(&words(line)).stdout(out).output().unwrap();
    let said = stderr(&output);
    assert!(!said.contains("panicked"), "{line}: {said}");
    output.status.code().unwrap_or_else(|| panic!("{line} is ended by a signal: {said}"))
}

/// Triangles at 2^100, along two axes: a builder of another crate panics on them.
fn huge(folder: &tempfile::TempDir) -> String {
    let mut text = String::new();
    for corners in [
        [[-1e30, -1e30, 1.26765e30], [1e30, -1e30, 1.26765e30], [0.0, 2e30, 1.26765e30]],
        [[-1e30, -1e30, -1.26765e30], [1e30, -1e30, -1.26765e30], [0.0, 2e30, -1.26765e30]],
        [[1.26765e30, -1e30, -1e30], [1.26765e30, 1e30, -1e30], [1.26765e30, 0.0, 2e30]],
    ] {
        text.extend(corners.map(|[x, y, z]: [f32; 3]| format!("v {x:e} {y:e} {z:e}\n")));
        text += "f -3 -2 -1\n";
    }
    write(folder, "huge.obj", &text)
}

#[test]
fn a_verdict_outlives_the_reader_of_its_output() {
    let folder = tempfile::tempdir().unwrap();
    let huge = huge(&folder);
    let wrong = "validate cube -s sah-kd:test=moller-trumbore --against brute-force:test=exact --adversarial --rays 2000 --strict";
    let refused = format!("validate {huge} -s obvhs-cwbvh --rays 10");
    for (line, expected) in [
        ("--help", RIGHT),
        ("compare --help", RIGHT),
        ("--version", RIGHT),
        ("list", RIGHT),
        ("completions man", RIGHT),
        ("render cube -o - --size 4x4", RIGHT),
        ("rays record cube -o - --rays 4", RIGHT),
        ("compare cube -s sah-kd --rays 64 --epochs 1", RIGHT),
        ("compare cube -s sah-kd --rays 64 --epochs 1 --export-json -", RIGHT),
        ("study accuracy cube -s sah-kd --rays 64 --in-process", RIGHT),
        (wrong, WRONG),
        ("validate --hard cube_random -s sah-kd --rays 64", RIGHT),
        (&refused, NOT_BUILT),
        ("compare sponsa", USAGE),
    ] {
        // No process can have read anything.
        let (reader, writer) = std::io::pipe().unwrap();
        drop(reader);
        assert_eq!(status(line, writer), expected, "{line} without a reader");
        if let Ok(full) = File::options().write(true).open("/dev/full") {
            assert_eq!(status(line, full), expected.max(USAGE), "{line} on a full disk");
        }
    }
}

#[test]
fn a_builder_that_panics_is_a_sentence_and_no_backtrace() {
    let folder = tempfile::tempdir().unwrap();
    let huge = huge(&folder);
    let run = |line: &str, status| ends(status, command(&words(line)).env("RUST_BACKTRACE", "1"));
    for command in ["validate", "compare"] {
        let line = format!("--quiet {command} {huge} -s obvhs-cwbvh -s sah-kd --rays 10");
        let (text, message) = run(&line, NOT_BUILT);
        assert_eq!(message, "", "{command}");
        assert_eq!(text.matches("its builder panicked on this mesh").count(), 1, "{text}");
    }
    let (_, message) = run(&format!("render {huge} -s obvhs-cwbvh -o {}", at(&folder, "x.png")), USAGE);
    assert!(message.lines().count() == 1 && message.contains("its builder panicked"), "{message}");
}
