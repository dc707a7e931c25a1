//! `report` from outside: the folder it writes, and what it refuses.

use std::fs;
use std::path::Path;
use std::process::{Command, Output, Stdio};

use tempfile::TempDir;

fn sahara(args: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_sahara"));
    command.args(args).arg("--quiet").env_remove("SAHARA_DATA").env_remove("NO_COLOR").stdin(Stdio::null());
    command.output().expect("the command runs")
}

/// What a command that succeeds prints.
#[track_caller]
fn prints(args: &[&str]) -> String {
    let output = sahara(args);
    assert!(output.status.success(), "{args:?}: {}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).expect("output is UTF-8")
}

/// The command fails in one sentence that holds all of `parts`.
#[track_caller]
fn refuses(args: &[&str], parts: &[&str]) {
    let output = sahara(args);
    let message = String::from_utf8(output.stderr).expect("messages are UTF-8");
    assert_eq!(output.status.code(), Some(1), "{args:?}: {message}");
    assert!(message.starts_with("error: ") && message.lines().count() == 1, "{args:?}: {message}");
    assert!(output.stdout.is_empty() && parts.iter().all(|part| message.contains(part)), "{args:?}: {message}");
}

fn text(path: &Path) -> &str {
    path.to_str().expect("the path is UTF-8")
}

/// A folder with a comparison of the cube.
fn runs() -> TempDir {
    let folder = TempDir::new().unwrap();
    let file = folder.path().join("compare.json");
    prints(&[
        "compare",
        "cube",
        "-s",
        "median-kd",
        "-s",
        "sah-kd",
        "--rays",
        "500",
        "--runs",
        "1",
        "--epochs",
        "1",
        "--export-json",
        text(&file),
    ]);
    folder
}

#[test]
fn a_report_is_written_whole_with_pictures_and_again_in_its_place() {
    let (runs, place) = (runs(), TempDir::new().unwrap());
    let output = place.path().join("report");
    for _ in 0..2 {
        let said = prints(&["report", text(runs.path()), "-o", text(&output)]);
        assert!(
            said.contains("Not measured") && said.contains("index.html") && said.contains("sahara replicate"),
            "{said}"
        );
    }
    let page = fs::read_to_string(output.join("index.html")).unwrap();
    for part in
        ["data:image/png;base64,", "heat-cube", "speed-cube", "<svg viewBox", "type=\"range\"", "prefers-color-scheme"]
    {
        assert!(page.contains(part), "{part}");
    }
    for file in [
        "report.md",
        "report.tex",
        "data/records.csv",
        "data/records.jsonl",
        "figures/speed-cube.svg",
        "figures/scenes-1.png",
    ] {
        assert!(output.join(file).is_file(), "{file}");
    }
    assert_eq!(fs::read_dir(place.path()).unwrap().count(), 1, "nothing is left beside it");

    // The same runs give the same page.
    let other = place.path().join("other");
    prints(&["report", text(runs.path()), "-o", text(&other)]);
    assert_eq!(fs::read_to_string(other.join("index.html")).unwrap(), page);
}

#[test]
fn what_cannot_be_reported_leaves_everything_as_it_was() {
    let (runs, place) = (runs(), TempDir::new().unwrap());
    let (run, output) = (text(runs.path()), place.path().join("notes"));
    fs::create_dir(&output).unwrap();
    fs::write(output.join("mine.txt"), "mine").unwrap();
    refuses(&["report", run, "-o", text(&output)], &["notes", "mine.txt", "another folder"]);
    refuses(&["report", run, "-o", text(&output.join("mine.txt"))], &["mine.txt", "file"]);
    assert_eq!(fs::read_to_string(output.join("mine.txt")).unwrap(), "mine");

    let new = place.path().join("new");
    let bytes = fs::read(runs.path().join("compare.json")).unwrap();
    fs::write(runs.path().join("torn.json"), &bytes[..bytes.len() / 2]).unwrap();
    refuses(&["report", run, "-o", text(&new)], &["torn.json", "torn"]);
    refuses(&["report", text(&place.path().join("none")), "-o", text(&new)], &["none"]);
    let empty = TempDir::new().unwrap();
    refuses(&["report", text(empty.path()), "-o", text(&new)], &["no run", "sahara study all"]);
    assert_eq!(fs::read_dir(place.path()).unwrap().count(), 1);
}
