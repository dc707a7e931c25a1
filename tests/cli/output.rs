//! What becomes of a verdict where its output cannot be written, and what is not printed at all.

use std::fs::File;
use std::process::Stdio;

use super::command::{RIGHT, USAGE, WRONG, command, path_text, stderr, stdout, write};

const REFUSED: i32 = 5;

/// The status with this standard output.
fn status(args: &[&str], out: impl Into<Stdio>) -> i32 {
    let output = command(args).stdout(out).output().unwrap();
    let said = stderr(&output);
    assert!(!said.contains("panicked"), "{args:?}: {said}");
    output.status.code().unwrap_or_else(|| panic!("{args:?} is ended by a signal: {said}"))
}

/// Triangles at 2^100, along two axes: a builder of others panics on them.
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
    let wrong =
        "validate cube -s sah-kd:test=moller-trumbore --against brute-force:test=exact --adversarial --rays 2000";
    let refused = ["validate", &huge, "-s", "obvhs-cwbvh", "--rays", "10"];
    let lines: [(Vec<&str>, i32); 13] = [
        (vec!["--help"], RIGHT),
        (vec!["compare", "--help"], RIGHT),
        (vec!["--version"], RIGHT),
        (vec!["list"], RIGHT),
        (vec!["completions", "man"], RIGHT),
        (vec!["render", "cube", "-o", "-", "--size", "4x4"], RIGHT),
        (vec!["rays", "record", "cube", "-o", "-", "--rays", "4"], RIGHT),
        ("compare cube -s sah-kd --rays 64 --epochs 1 --export-json -".split(' ').collect(), RIGHT),
        ("study accuracy cube -s sah-kd --rays 64 --in-process".split(' ').collect(), RIGHT),
        (wrong.split(' ').collect(), WRONG),
        ("validate --hard cube_random -s sah-kd --rays 64".split(' ').collect(), RIGHT),
        (refused.to_vec(), REFUSED),
        (vec!["compare", "sponsa"], USAGE),
    ];
    for (args, expected) in &lines {
        // Nobody can have read anything.
        let (reader, writer) = std::io::pipe().unwrap();
        drop(reader);
        assert_eq!(status(args, writer), *expected, "{args:?} without a reader");
        if let Ok(full) = File::options().write(true).open("/dev/full") {
            assert_eq!(status(args, full), *expected.max(&USAGE), "{args:?} on a full disk");
        }
    }
}

#[test]
fn a_builder_that_panics_is_a_sentence_and_no_backtrace() {
    let folder = tempfile::tempdir().unwrap();
    let huge = huge(&folder);
    let all = ["-s", "obvhs-cwbvh", "-s", "sah-kd", "--rays", "10"];
    for (command_name, status) in [("validate", REFUSED), ("compare", REFUSED)] {
        let args = [&["--quiet", command_name, &huge], &all[..]].concat();
        let output = command(&args).env("RUST_BACKTRACE", "1").output().unwrap();
        assert_eq!((stderr(&output), output.status.code()), (String::new(), Some(status)), "{command_name}");
        assert_eq!(stdout(&output).matches("its builder panicked on this mesh").count(), 1, "{}", stdout(&output));
    }
    let picture = path_text(&folder.path().join("x.png"));
    let args = ["render", &huge, "-s", "obvhs-cwbvh", "-o", &picture];
    let output = command(&args).env("RUST_BACKTRACE", "1").output().unwrap();
    let message = stderr(&output);
    assert!(message.lines().count() == 1 && message.contains("its builder panicked"), "{message}");
}
