//! Tests the regression gate with the script and the commands of GATE.md.
//!
//! A shell script with prescribed times replaces the measured structure.
#![cfg(unix)]

use std::fs;
use std::process::{Command, Output};

use super::command::{Folder, REGRESSION, RIGHT, output_texts};
use super::runner::NOTHING;

const DOCUMENT: &str = include_str!("../../src/study/diff/GATE.md");

/// A folder with `gate.sh`, a faster version of the script in GATE.md. The reference is the runner `steady`.
fn gated(only: &str, options: &str) -> Folder {
    let folder = Folder::new();
    folder.write("away.txt", "9,9,9 0,0,1\n".repeat(64));
    folder.prints("rays import away.txt -o away.rays --scene cube");
    folder.program("steady.sh", NOTHING);
    let steady = format!("--reference steady --runner steady={}", folder.path("steady.sh").display());
    let script = DOCUMENT.split("```sh\n").nth(1).and_then(|rest| rest.split("```").next()).unwrap();
    let replaced = [
        ("teapot starters cornellbox", format!("--rays {}", folder.path("away.rays").display())),
        ("--only $name", format!("--only {only} {steady} {options} --quiet")),
        ("4 8 16", "3 6".into()),
        ("--looks 3", "--looks 3 --reference steady".into()),
    ];
    let script = replaced.iter().fold(script.to_owned(), |script, (there, here)| {
        assert!(script.contains(there), "{there:?} is not in {script}");
        script.replace(there, here)
    });
    folder.program("gate.sh", &script);
    folder
}

/// The arguments of the `nth` call of `gate.sh` in GATE.md, counted from 0.
fn arguments(nth: usize) -> &'static str {
    DOCUMENT.lines().filter_map(|line| line.trim().strip_prefix("- run: sh gate.sh ")).nth(nth).unwrap()
}

fn shell(folder: &Folder, line: &str) -> Output {
    let mut shell = Command::new("sh");
    shell.args(["-c", line]).env("RUNNER_TEMP", folder.path("")).current_dir(folder.path("")).output().unwrap()
}

/// Runs `gate.sh` with the arguments of the `nth` call in GATE.md. `base` and `branch` contain the seconds per pass in
/// even epochs and in odd epochs.
///
/// Returns the output and the number of measured epochs of the branch.
fn gate(nth: usize, base: [f64; 2], branch: [f64; 2]) -> (Output, usize) {
    let command = arguments(nth);
    // The prefix `my-` is needed because a runner must not have the name of a structure.
    let folder = gated("my-$name", "--runner my-$name=$RUNNER_TEMP/told.sh");
    // The parent process of the runner changes with each epoch. Line n of the file `STARTS` contains the parent's
    // process ID in epoch n - 1.
    let starts = "grep -qx $PPID \"$STARTS\" 2>/dev/null || echo $PPID >> \"$STARTS\"\n\
                  n=$(grep -nx $PPID \"$STARTS\" | cut -d: -f1)\n\
                  if [ $((n % 2)) -eq 1 ]; then own=$EVEN; else own=$ODD; fi\n";
    let runner = NOTHING.replacen("#!/bin/sh\n", &format!("#!/bin/sh\n{starts}"), 1);
    folder.program("told.sh", &runner.replace("*) echo \"passed 0.001\"", "*) echo \"passed $own\""));
    let sahara = env!("CARGO_BIN_EXE_sahara");
    // Two scripts replace the executables of base and branch. Each script sets the seconds per pass.
    let sides = command.split_whitespace().take(2).map(|word| word.trim_matches('"').replace("$RUNNER_TEMP/", ""));
    for (path, [even, odd]) in sides.zip([base, branch]) {
        let starts = folder.path(&(path.replace('/', "-") + ".starts"));
        let environment = format!("STARTS={} EVEN={even} ODD={odd}", starts.display());
        folder.program(&path, &format!("#!/bin/sh\nexport {environment}\nexec {sahara} \"$@\"\n"));
    }
    let output = shell(&folder, &format!("sh gate.sh {command}"));
    let epochs = fs::read_dir(folder.path("runs-branch/compare")).map_or(0, Iterator::count);
    (output, epochs)
}

#[test]
fn the_gate_passes_what_is_unchanged_fails_what_is_slower_and_ends_where_it_cannot_tell() {
    for (nth, base, branch, status, epochs, verdict) in [
        (0, [0.001; 2], [0.001; 2], RIGHT, 3, "my-sah-hybrid (own clock): right on 64 checked rays; no change"),
        (0, [0.001; 2], [0.0012; 2], REGRESSION, 3, "% slower"),
        // The large difference between even and odd epochs makes the result inconclusive.
        (0, [0.001; 2], [0.0004, 0.0025], RIGHT, 6, "inconclusive"),
        (1, [0.001; 2], [0.0012; 2], REGRESSION, 3, "my-mybvh (own clock): right on 64 checked rays;"),
    ] {
        let (output, measured) = gate(nth, base, branch);
        let text = output_texts(&output).concat();
        assert_eq!((output.status.code(), measured), (Some(status), epochs), "{base:?} {branch:?}: {text}");
        assert!(text.contains(verdict), "{verdict:?} is not in {text}");
    }
}

#[test]
fn one_sahara_gates_a_program() {
    for (seconds, status, verdict) in [("0.001", RIGHT, "no change"), ("0.0012", REGRESSION, "over the limit of 10 %")]
    {
        let folder = gated("$name", "");
        folder.program("bvh-base", NOTHING);
        folder.program("bvh", &NOTHING.replace("passed 0.001", &format!("passed {seconds}")));
        folder.program("bin/sahara", &format!("#!/bin/sh\nexec {} \"$@\"\n", env!("CARGO_BIN_EXE_sahara")));
        let output = shell(&folder, &format!("PATH=$PWD/bin:$PATH sh gate.sh {}", arguments(2)));
        let text = output_texts(&output).concat();
        assert!(output.status.code() == Some(status) && text.contains(verdict), "{seconds}: {text}");
    }
}
