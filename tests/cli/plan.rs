//! Tests `study plan`, which prints independent jobs.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

use sahara::study::{Studies, Study};

use super::command::{Folder, RIGHT, SQUARE, command, ends, json, output_texts, refused_in_a_line};
use super::journal::answers;

const SMALL: &str = "attribution --rays 64 --runs 1 --budget 1 --epochs 2";

pub fn plan(folder: &Path, args: &str) -> Vec<String> {
    Folder::new().prints(&format!("study plan {args} --dir '{}'", folder.display())).lines().map(String::from).collect()
}

pub fn job(line: &str) -> Command {
    let mut command = command(line.strip_prefix("sahara ").unwrap_or_else(|| panic!("{line}")));
    command.stdout(Stdio::piped()).stderr(Stdio::piped());
    command
}

/// The file that a job writes.
pub fn file(line: &str) -> PathBuf {
    let job = job(line);
    let words: Vec<_> = job.get_args().collect();
    let [.., "--out", file] = words.iter().map(|word| word.to_str().unwrap()).collect::<Vec<_>>()[..] else {
        panic!("{line}")
    };
    file.into()
}

fn done(line: &str) -> String {
    let [text, log] = ends(RIGHT, &mut job(line));
    assert!(text.is_empty() && file(line).is_file());
    log
}

#[track_caller]
fn refused(line: &str, parts: &[&str]) {
    refused_in_a_line(&mut job(line), parts);
}

#[test]
fn a_plan_is_one_command_a_case_with_a_file_of_its_own() {
    let folder = Folder::new();
    let dir = folder.path("my runs");
    let args = format!("{SMALL} --scenes cube sphere");
    let lines = plan(&dir, &args);
    assert_eq!(lines.len(), 4, "two epochs of two scenes");
    assert_eq!(plan(&dir, &args), lines, "the same plan has the same names");
    let files: BTreeSet<PathBuf> = lines.iter().map(|line| file(line)).collect();
    for path in &files {
        assert_eq!(path.parent().unwrap(), dir.join("attribution"));
        let name = path.file_name().unwrap().to_str().unwrap().strip_suffix(".json").unwrap();
        assert!(name.chars().all(|c| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '-'), "{name}");
    }
    assert!(files.len() == 4 && !dir.exists(), "a plan creates no files");

    // A study that is named twice is planned once. The scenes of several `--scenes` options add up.
    assert_eq!(plan(&dir, "compare compare --scenes cube"), plan(&dir, "compare --scenes cube"));
    assert_eq!(plan(&dir, "compare --scenes torus --scenes cube"), plan(&dir, "compare --scenes torus cube"));

    let lines = plan(Path::new("r"), "--quick --scenes cube");
    let files: BTreeSet<PathBuf> = lines.iter().map(|line| file(line)).collect();
    for Study { name, .. } in Studies::builtin().iter() {
        assert!(files.iter().any(|file| file.starts_with(format!("r/{name}"))), "{name}: {files:?}");
    }
    assert_eq!(files.len(), lines.len());
}

#[test]
fn what_cannot_be_planned_is_one_sentence() {
    let twice = "cannot be used multiple times";
    for (line, parts) in [
        ("attributoin", &["attributoin"][..]),
        ("all attributoin --quick", &["attributoin"]),
        ("attribution --scenes cub", &["cub", "Cube"]),
        ("attribution scaling --scenes", &["--scenes SCENE"]),
        ("--dir a compare scaling --dir=b", &["--dir", twice]),
        ("compare scaling --dir a --dir b", &["--dir", twice]),
        ("compare --rays 64 --quick --quick", &["--quick", twice]),
        // `study plan` rejects options that write results.
        ("attribution --rays 64 --export-json x.json", &["--", "when all jobs are done"]),
        ("attribution --rays 64 --export-csv=x.csv", &["--", "when all jobs are done"]),
        ("attribution --rays 64 --plot x.svg", &["--", "when all jobs are done"]),
        ("attribution --scenes cube --plot x.svg", &["--plot", "when all jobs are done"]),
        ("attribution --rays 64 --fresh", &["--fresh", "--dir"]),
    ] {
        Folder::new().refuses_in_a_line(&format!("study plan {line}"), parts);
    }
    for (line, parts) in [
        ("attribution --quick --epoch 3", &["--epoch"][..]),
        ("attribution --quick --epochs 3", &["--epochs", twice]),
        ("--no-such-option 64", &["--no-such-option"]),
        ("compare --dir a --dir b", &["--dir", twice]),
    ] {
        Folder::new().refuses(&format!("study plan {line}"), parts);
    }
}

#[test]
fn jobs_in_any_order_are_the_study() {
    let folder = Folder::new();
    let [apart, one] = ["apart", "one"].map(|name| folder.path(name));
    let lines = plan(&apart, &format!("{SMALL} --scenes cube sphere"));
    for line in lines.iter().rev() {
        let log = done(line);
        assert!(log.starts_with("measuring "), "its log says what it was: {log}");
    }
    folder.prints(&format!("study {SMALL} --dir one --in-process cube sphere"));
    assert_eq!(answers(&apart, "attribution").len(), 4);
    assert_eq!(answers(&apart, "attribution"), answers(&one, "attribution"));

    // The study must not change the files of the jobs.
    let before: Vec<Vec<u8>> = lines.iter().map(|line| fs::read(file(line)).unwrap()).collect();
    assert!(folder.prints(&format!("study {SMALL} --dir apart cube sphere")).contains("Cube"));
    assert_eq!(lines.iter().map(|line| fs::read(file(line)).unwrap()).collect::<Vec<_>>(), before);
    assert_eq!(fs::read_dir(apart.join("attribution")).unwrap().count(), 4);

    // The provenance contains the command of the study, not the command of the job.
    let provenance = &json(file(&lines[0]))["provenance"];
    for field in ["host", "cpu", "commit", "target_features", "date", "command"] {
        assert!(!provenance[field].as_str().unwrap().is_empty(), "{field}");
    }
    let command = provenance["command"].as_str().unwrap();
    assert!(command.ends_with("study attribution cube sphere --rays 64 --runs 1 --budget 1 --epochs 2"), "{command}");
}

#[test]
fn a_job_measures_once_and_refuses_what_is_not_its_own() {
    let folder = Folder::new();
    folder.write("square.obj", SQUARE);
    let mesh = folder.path("square.obj").to_str().unwrap().to_owned();
    let lines = plan(&folder.path(""), &format!("{SMALL} --scenes {mesh}"));
    // Two jobs for one file run at the same time. Both jobs succeed.
    let both = [0, 1].map(|_| job(&lines[0]).spawn().unwrap());
    let both = both.map(|child| child.wait_with_output().unwrap());
    assert!(both.iter().all(|output| output.status.code() == Some(RIGHT)), "{both:?}");
    let is_other = |output: &&Output| {
        ["already contains this case", "its case is kept"].iter().any(|part| output_texts(output)[1].contains(part))
    };
    assert_eq!(both.iter().filter(is_other).count(), 1, "{both:?}");
    assert_eq!(fs::read_dir(folder.path("attribution")).unwrap().count(), 1);
    let path = file(&lines[0]);
    assert_eq!(json(&path)["case"]["study"], "attribution");
    let before = fs::read(&path).unwrap();
    // A repeated job does not load the mesh.
    let away = folder.path("away.obj");
    fs::rename(&mesh, &away).unwrap();
    let log = done(&lines[0]);
    assert!(log.contains("nothing is measured") && log.lines().count() == 1, "{log}");
    refused(&lines[1], &[&mesh]);
    fs::rename(&away, &mesh).unwrap();

    let hash = &lines[1].split("\"hash\":\"").nth(1).unwrap()[..16];
    for (from, to, part) in [
        (file(&lines[1]).to_str().unwrap(), path.to_str().unwrap(), "contains another case"),
        (hash, "0123456789abcdef", "plan it again"),
        (&format!("\"word\":\"{mesh}"), "\"word\":\"torus", "plan it again"),
    ] {
        refused(&lines[1].replace(from, to), &[part]);
    }
    assert_eq!(fs::read(&path).unwrap(), before);
    let cores = std::thread::available_parallelism().unwrap().get();
    let threads = cores + 1;
    let many = plan(&folder.path(""), &format!("{SMALL} --scenes {mesh} --threads {threads}"));
    refused(&many[0], &["cannot be measured", &format!("{threads} threads share {cores} core")]);
    assert!(!file(&lines[1]).exists() && !file(&many[0]).exists());
}

#[test]
fn what_cannot_be_written_is_one_sentence_and_no_file() {
    let folder = Folder::new();
    let lines = plan(&folder.path("runs"), &format!("{SMALL} --scenes cube"));
    // The file `runs` prevents the creation of the folder `runs`.
    folder.write("runs", "x");
    refused(&lines[0], &["cannot write", "runs/attribution"]);
    fs::remove_file(folder.path("runs")).unwrap();

    // Simulate a full disk with a limit of one block per file.
    #[cfg(target_os = "linux")]
    {
        let job = lines[0].strip_prefix("sahara ").unwrap();
        let script = format!("trap '' XFSZ; ulimit -f 1; exec \"$0\" --quiet {job}");
        let mut shell = Command::new("sh");
        shell.args(["-c", &script, env!("CARGO_BIN_EXE_sahara")]).env_remove("SAHARA_DATA").stdin(Stdio::null());
        refused_in_a_line(&mut shell, &["cannot write", "free some space"]);
        assert_eq!(fs::read_dir(folder.path("runs/attribution")).unwrap().count(), 0, "nothing is left");
    }
    done(&lines[0]);
}
