//! A job of `study plan`: what it measures, and what becomes of it.

use std::fs;
use std::io::{BufRead, BufReader};
use std::process::{Command, Output, Stdio};

use tempfile::TempDir;

use super::command::{RIGHT, SQUARE, json, refused_in_a_line, stderr, write};
use super::journal::cases;
use super::plan::{SMALL, done, file, job, plan, run};

#[test]
fn a_job_on_fewer_cores_than_threads_measures_nothing() {
    let folder = TempDir::new().unwrap();
    let cores = std::thread::available_parallelism().unwrap().get();
    let threads = (cores + 1).to_string();
    let lines = plan(folder.path(), &[&SMALL[..], &["--scenes", "cube", "--threads", &threads]].concat());
    refused_in_a_line(&run(&lines[0]), &["cannot be measured", &format!("{threads} threads share {cores} core")]);
    assert!(!file(&lines[0]).exists());
}

#[test]
fn a_job_measures_once_and_refuses_what_is_not_its_own() {
    let folder = TempDir::new().unwrap();
    let mesh = write(&folder, "square.obj", SQUARE);
    let lines = plan(folder.path(), &[&SMALL[..], &["--scenes", &mesh]].concat());
    done(&lines[0]);
    let path = file(&lines[0]);
    let before = fs::read(&path).unwrap();
    // What is repeated loads nothing.
    let away = folder.path().join("away.obj");
    fs::rename(&mesh, &away).unwrap();
    let again = run(&lines[0]);
    assert_eq!(again.status.code(), Some(RIGHT), "{}", stderr(&again));
    assert!(stderr(&again).contains("nothing is measured") && stderr(&again).lines().count() == 1);
    refused_in_a_line(&run(&lines[1]), &[&mesh]);
    fs::rename(&away, &mesh).unwrap();

    let refused = |line: &str, part: &str| refused_in_a_line(&run(line), &[part]);
    refused(&lines[1].replace(file(&lines[1]).to_str().unwrap(), path.to_str().unwrap()), "holds another case");
    assert_eq!(fs::read(&path).unwrap(), before);
    // Its scene must be what it was when it was planned.
    let hash = lines[1].split("\"hash\":\"").nth(1).unwrap()[..16].to_owned();
    refused(&lines[1].replace(&hash, "0123456789abcdef"), "plan it anew");
    refused(&lines[1].replace(&format!("\"word\":\"{mesh}"), "\"word\":\"torus"), "plan it anew");
    assert!(!file(&lines[1]).exists());
}

#[test]
fn of_two_jobs_at_one_file_one_wins_and_both_are_content() {
    let folder = TempDir::new().unwrap();
    let lines = plan(folder.path(), &[&SMALL[..], &["--scenes", "cube"]].concat());
    let both = [0, 1].map(|_| job(&lines[0]).spawn().unwrap());
    let both = both.map(|child| child.wait_with_output().unwrap());
    assert!(both.iter().all(|output| output.status.code() == Some(RIGHT)), "{both:?}");
    let is_other = |output: &&Output| {
        ["holds this case already", "its case is kept"].iter().any(|part| stderr(output).contains(part))
    };
    assert_eq!(both.iter().filter(is_other).count(), 1, "{both:?}");
    assert_eq!(fs::read_dir(folder.path().join("attribution")).unwrap().count(), 1);
    assert_eq!(json(file(&lines[0]))["case"]["study"], "attribution");
}

#[test]
fn a_job_that_is_killed_leaves_no_result() {
    let folder = TempDir::new().unwrap();
    let lines = plan(folder.path(), &[&SMALL[..], &["--scenes", "sphere"]].concat());
    let mut child = job(&lines[0]).spawn().unwrap();
    let mut said = String::new();
    BufReader::new(child.stderr.take().unwrap()).read_line(&mut said).unwrap();
    assert!(said.starts_with("measures "), "{said}");
    child.kill().unwrap();
    child.wait().unwrap();
    assert!(cases(folder.path(), "attribution").is_empty());
    done(&lines[0]);
}

#[test]
fn what_cannot_be_written_is_one_sentence_and_no_file() {
    let folder = TempDir::new().unwrap();
    let lines = plan(&folder.path().join("runs"), &[&SMALL[..], &["--scenes", "cube"]].concat());
    // A file stands where the folder should be.
    fs::write(folder.path().join("runs"), "x").unwrap();
    refused_in_a_line(&run(&lines[0]), &["cannot write", "runs/attribution"]);
    fs::remove_file(folder.path().join("runs")).unwrap();

    // As on a full disk: the system takes no more than a thousand bytes of a file.
    #[cfg(target_os = "linux")]
    {
        let job = lines[0].strip_prefix("sahara ").unwrap();
        let shell = format!("trap '' XFSZ; ulimit -f 1; exec \"$0\" --quiet {job}");
        let mut command = Command::new("sh");
        command.args(["-c", &shell, env!("CARGO_BIN_EXE_sahara")]).env_remove("SAHARA_DATA");
        let output = command.stdin(Stdio::null()).output().unwrap();
        refused_in_a_line(&output, &["cannot write", "give it room"]);
        assert_eq!(fs::read_dir(folder.path().join("runs/attribution")).unwrap().count(), 0, "nothing is left");
    }
    done(&lines[0]);
}
