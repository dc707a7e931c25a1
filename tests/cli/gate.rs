//! The gate, with the commands of its document: a runner with prescribed times replaces a structure.
#![cfg(unix)]

use std::fs;
use std::os::unix::fs::PermissionsExt;
use std::process::{Command, Output};

use tempfile::TempDir;

use super::command::{REGRESSION, RIGHT, path_text, prints, stderr, stdout, write};
use super::runner::NOTHING;

const DOCUMENT: &str = include_str!("../../src/study/diff/GATE.md");

/// The script of the document over rays that miss everything, with runners instead of the structure and the reference,
/// and with fewer epochs.
fn script(rays: &str, own: &str, yardstick: &str) -> String {
    let script = DOCUMENT.split("```sh\n").nth(1).and_then(|rest| rest.split("```").next()).unwrap();
    // A runner must not have the name of a structure.
    let runners = "--only my-$name --reference steady --runner";
    let runners = format!("{runners} my-$name={own} --runner steady={yardstick} --quiet");
    let replaced = [
        ("teapot starters cornellbox", format!("--rays {rays}")),
        ("--only $name", runners),
        ("4 8 16", "3 6".into()),
        ("--looks 3", "--looks 3 --reference steady".into()),
    ];
    replaced.iter().fold(script.to_owned(), |script, (there, here)| {
        assert!(script.contains(there), "{there:?} is not in {script}");
        script.replace(there, here)
    })
}

/// Runs the `nth` command of the document that runs the script, with prescribed seconds per pass on both sides, for
/// even and for odd epochs. Returns its output, and the number of measured epochs of the branch.
fn gate(nth: usize, base: [f64; 2], branch: [f64; 2]) -> (Output, usize) {
    let command = DOCUMENT.lines().filter_map(|line| line.trim().strip_prefix("- run: sh gate.sh ")).nth(nth).unwrap();
    let folder = TempDir::new().unwrap();
    let program = |name: &str, text: &str| {
        fs::create_dir_all(folder.path().join(name).parent().unwrap()).unwrap();
        let path = write(&folder, name, text);
        fs::set_permissions(&path, fs::Permissions::from_mode(0o755)).unwrap();
        path
    };
    let (text, rays) =
        (write(&folder, "away.txt", &"9,9,9 0,0,1\n".repeat(64)), path_text(&folder.path().join("away.rays")));
    prints(&["rays", "import", &text, "-o", &rays, "--scene", "cube"]);
    // Each epoch is a process that starts the runner and its twin: the runners of every second process have the same
    // seconds.
    let starts = "grep -qx $PPID \"$STARTS\" 2>/dev/null || echo $PPID >> \"$STARTS\"\n\
                  n=$(grep -nx $PPID \"$STARTS\" | cut -d: -f1)\n\
                  if [ $((n % 2)) -eq 1 ]; then own=$EVEN; else own=$ODD; fi\n";
    let runner = NOTHING.replacen("#!/bin/sh\n", &format!("#!/bin/sh\n{starts}"), 1);
    let runner = program("told.sh", &runner.replace("*) echo \"passed 0.001\"", "*) echo \"passed $own\""));
    let yardstick = program("steady.sh", NOTHING);
    program("gate.sh", &script(&rays, &runner, &yardstick));
    let sahara = env!("CARGO_BIN_EXE_sahara");
    // The programs of both sides, at the place of the workflow's builds.
    let sides = command.split_whitespace().take(2).map(|word| word.trim_matches('"').replace("$RUNNER_TEMP/", ""));
    for (path, [even, odd]) in sides.zip([base, branch]) {
        let starts = path_text(&folder.path().join(path.replace('/', "-") + ".starts"));
        program(&path, &format!("#!/bin/sh\nexport STARTS={starts} EVEN={even} ODD={odd}\nexec {sahara} \"$@\"\n"));
    }
    let mut shell = Command::new("sh");
    shell.args(["-c", &format!("sh gate.sh {command}")]).env("RUNNER_TEMP", folder.path());
    let output = shell.current_dir(folder.path()).output().unwrap();
    let epochs = fs::read_dir(folder.path().join("runs-branch/compare")).map_or(0, Iterator::count);
    (output, epochs)
}

#[test]
fn the_gate_passes_what_is_unchanged_fails_what_is_slower_and_ends_where_it_cannot_tell() {
    for (nth, base, branch, status, epochs, verdict) in [
        (0, [0.001; 2], [0.001; 2], RIGHT, 3, "my-sah-hybrid (own clock): right on 64 checked rays; no change"),
        (0, [0.001; 2], [0.0012; 2], REGRESSION, 3, "% slower"),
        // Every second epoch is much slower: more epochs do not decide either.
        (0, [0.001; 2], [0.0004, 0.0025], RIGHT, 6, "inconclusive"),
        (1, [0.001; 2], [0.0012; 2], REGRESSION, 3, "my-mybvh (own clock): right on 64 checked rays;"),
    ] {
        let (output, measured) = gate(nth, base, branch);
        let said = stdout(&output) + &stderr(&output);
        assert_eq!((output.status.code(), measured), (Some(status), epochs), "{base:?} {branch:?}: {said}");
        assert!(said.contains(verdict), "{verdict:?} is not in {said}");
    }
}
