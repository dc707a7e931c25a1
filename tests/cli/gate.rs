//! The gate, by the commands of its document: a runner that says prescribed seconds stands in place of a structure.
#![cfg(unix)]

use std::fs;
use std::os::unix::fs::PermissionsExt;
use std::process::{Command, Output};

use tempfile::TempDir;

use super::command::{REGRESSION, RIGHT, path_text, prints, stderr, stdout, write};
use super::runner::NOTHING;

/// The script of the document over rays that hit nothing, with the runner alone and fewer epochs.
fn script(rays: &str, runner: &str) -> String {
    let document = include_str!("../../src/study/diff/GATE.md");
    let script = document.split("```sh\n").nth(1).and_then(|rest| rest.split("```").next()).unwrap();
    let own = [
        ("teapot starters cornellbox", format!("--rays {rays}")),
        ("-s sah-kd -s sah-hybrid -s obvhs-bvh2", format!("-s none --runner {runner} --quiet")),
        ("12 24 48", "3 6".into()),
    ];
    own.iter().fold(script.to_owned(), |script, (there, here)| {
        assert!(script.contains(there), "{there:?} is not in {script}");
        script.replace(there, here)
    })
}

/// Runs the script with prescribed seconds of a pass on both sides, those of even and of odd epochs; what it says, and how
/// many epochs of the branch were measured.
fn gate(base: [f64; 2], branch: [f64; 2]) -> (Output, usize) {
    let folder = TempDir::new().unwrap();
    let program = |name: &str, text: &str| {
        let path = write(&folder, name, text);
        fs::set_permissions(&path, fs::Permissions::from_mode(0o755)).unwrap();
        path
    };
    let (text, rays) =
        (write(&folder, "away.txt", &"9,9,9 0,0,1\n".repeat(64)), path_text(&folder.path().join("away.rays")));
    prints(&["rays", "import", &text, "-o", &rays, "--scene", "cube"]);
    // Each epoch is a process that starts the runner and its twin: those of every other process have the same seconds.
    let starts = "grep -qx $PPID \"$STARTS\" 2>/dev/null || echo $PPID >> \"$STARTS\"\n\
                  n=$(grep -nx $PPID \"$STARTS\" | cut -d: -f1)\n\
                  if [ $((n % 2)) -eq 1 ]; then own=$EVEN; else own=$ODD; fi\n";
    let runner = NOTHING.replacen("#!/bin/sh\n", &format!("#!/bin/sh\n{starts}"), 1);
    let runner = program("told.sh", &runner.replace("*) echo \"passed 0.001\"", "*) echo \"passed $own\""));
    let sahara = env!("CARGO_BIN_EXE_sahara");
    let side = |name: &str, [even, odd]: [f64; 2]| {
        let starts = path_text(&folder.path().join(format!("{name}.starts")));
        program(name, &format!("#!/bin/sh\nexport STARTS={starts} EVEN={even} ODD={odd}\nexec {sahara} \"$@\"\n"))
    };
    let sides = [side("base", base), side("branch", branch)];
    let script = program("gate.sh", &script(&rays, &runner));
    let output = Command::new("sh").arg(&script).args(&sides).current_dir(folder.path()).output().unwrap();
    let epochs = fs::read_dir(folder.path().join("runs-branch/compare")).map_or(0, Iterator::count);
    (output, epochs)
}

#[test]
fn the_gate_passes_what_is_unchanged_fails_what_is_slower_and_ends_where_it_cannot_tell() {
    for (base, branch, status, epochs) in [
        ([0.001; 2], [0.001; 2], RIGHT, 3),
        ([0.001; 2], [0.0012; 2], REGRESSION, 3),
        // Every other epoch is much slower: more epochs do not tell either.
        ([0.001; 2], [0.0004, 0.0025], RIGHT, 6),
    ] {
        let (output, measured) = gate(base, branch);
        let said = stdout(&output) + &stderr(&output);
        assert_eq!((output.status.code(), measured), (Some(status), epochs), "{base:?} {branch:?}: {said}");
        assert_eq!(said.contains("too noisy to tell"), epochs == 6, "{said}");
    }
}
