//! `study plan`: jobs that need each other in nothing, one file each, and what becomes of them.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

use serde_json::Value;
use tempfile::TempDir;

use super::command::{
    RIGHT, command, json, prints, refused_in_a_line, refuses, refuses_in_a_line, sahara, stderr, stdout,
};
use super::journal::answers;

/// A study of seconds.
pub const SMALL: [&str; 9] = ["attribution", "--rays", "64", "--runs", "1", "--budget", "1", "--epochs", "2"];
const SCENES: [&str; 3] = ["--scenes", "cube", "sphere"];

/// The lines of a plan.
pub fn plan(folder: &Path, args: &[&str]) -> Vec<String> {
    let dir = folder.to_str().unwrap();
    let text = prints(&[&["study", "plan"], args, &["--dir", dir]].concat());
    text.lines().map(String::from).collect()
}

/// What a shell makes of a line.
fn words(line: &str) -> Vec<String> {
    let words = shlex::split(line).unwrap_or_else(|| panic!("{line}"));
    assert_eq!(words[0], "sahara", "{line}");
    words
}

pub fn file(line: &str) -> PathBuf {
    let words = words(line);
    assert_eq!(words[words.len() - 2], "--out", "{line}");
    words[words.len() - 1].clone().into()
}

/// A job, as a shell on some machine would start it.
pub fn job(line: &str) -> Command {
    let words = words(line);
    let mut command = command(&words[1..].iter().map(String::as_str).collect::<Vec<_>>());
    command.stdout(Stdio::piped()).stderr(Stdio::piped());
    command
}

pub fn run(line: &str) -> Output {
    job(line).output().unwrap()
}

pub fn done(line: &str) {
    let output = run(line);
    assert_eq!(output.status.code(), Some(RIGHT), "{}", stderr(&output));
    assert!(output.stdout.is_empty() && file(line).is_file());
    assert!(stderr(&output).starts_with("measures "), "its log says what it was: {}", stderr(&output));
}

#[test]
fn a_plan_is_one_command_a_case_with_a_file_of_its_own() {
    let folder = TempDir::new().unwrap();
    let dir = folder.path().join("my runs");
    let args = [&SMALL[..], &SCENES].concat();
    let lines = plan(&dir, &args);
    assert_eq!(lines.len(), 4, "two epochs of two scenes");
    assert_eq!(plan(&dir, &args), lines, "the same plan has the same names");
    let mut files: Vec<PathBuf> = lines.iter().map(|line| file(line)).collect();
    for path in &files {
        assert_eq!(path.parent().unwrap(), dir.join("attribution"));
        let name = path.file_name().unwrap().to_str().unwrap().strip_suffix(".json").unwrap();
        assert!(name.chars().all(|c| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '-'), "{name}");
    }
    files.sort();
    files.dedup();
    assert_eq!(files.len(), 4);
    assert!(!dir.exists(), "nothing is made");

    // All studies, in the quick form.
    let output = sahara(&["study", "plan", "--quick", "--dir", "r"]);
    let (text, said) = (stdout(&output), stderr(&output));
    assert_eq!(output.status.code(), Some(RIGHT), "{said}");
    let mut names: Vec<String> = text.lines().map(|line| file(line).to_str().unwrap().to_owned()).collect();
    for study in ["compare", "replicate", "attribution", "scaling", "accuracy", "counts", "crossover", "predictions"] {
        assert!(names.iter().any(|name| name.starts_with(&format!("r/{study}/"))), "{study}: {names:?}");
    }
    let has_threads = names.iter().any(|name| name.starts_with("r/threads/"));
    assert_eq!(has_threads, std::thread::available_parallelism().unwrap().get() > 1, "one core leaves them out");
    let count = names.len();
    names.sort();
    names.dedup();
    assert_eq!(names.len(), count);
}

/// A process that may use one core.
#[cfg(target_os = "linux")]
#[test]
fn a_machine_of_one_core_has_no_jobs_for_threads() {
    let mut taskset = Command::new("taskset");
    taskset.args(["-c", &one_core(), env!("CARGO_BIN_EXE_sahara"), "study", "plan", "all", "--quick", "--dir", "r"]);
    let Ok(output) = taskset.env_remove("SAHARA_DATA").output() else {
        println!("skipped: there is no taskset here");
        return;
    };
    let (text, said) = (stdout(&output), stderr(&output));
    assert_eq!(output.status.code(), Some(RIGHT), "{said}");
    assert!(text.contains("r/counts/") && !text.contains("r/threads/"), "{text}");
    assert!(said.contains("threads: no jobs, for one core"), "{said}");
}

/// The first core that this process may use.
#[cfg(target_os = "linux")]
fn one_core() -> String {
    let status = fs::read_to_string("/proc/self/status").unwrap();
    let list = status.lines().find_map(|line| line.strip_prefix("Cpus_allowed_list:")).unwrap().trim();
    list.split([',', '-']).next().unwrap().into()
}

#[test]
fn what_cannot_be_planned_is_one_sentence() {
    refuses_in_a_line(&["study", "plan", "attributoin"], &["attributoin"]);
    refuses_in_a_line(&["study", "plan", "all", "attributoin", "--quick"], &["attributoin"]);
    refuses_in_a_line(&["study", "plan", "attribution", "--scenes", "cub"], &["cub", "Cube"]);
    refuses_in_a_line(&["study", "plan", "attribution", "costs", "--scenes"], &["--scenes SCENE"]);
    refuses_in_a_line(&["study", "plan", "attribution", "--scenes", "cube", "--dir", "a\tb"], &["tab"]);
    refuses(&["study", "plan", "attribution", "--quick", "--epoch", "3"], &["--epoch"]);
    // An option that is given twice, wherever it stands; one of them may be of the preset.
    let twice = "cannot be used multiple times";
    let preset = "bring options of their own";
    refuses(&["study", "plan", "attribution", "--quick", "--epochs", "3"], &["--epochs", twice, "attribution", preset]);
    refuses(&["study", "plan", "--no-such-option", "64"], &["--no-such-option", preset]);
    refuses(&["study", "plan", "counts", "--dir", "a", "--dir", "b"], &["--dir", twice]);
    for line in ["--dir a counts costs --dir=b", "counts costs --dir a --dir b"] {
        let options: Vec<&str> = line.split(' ').collect();
        refuses_in_a_line(&[&["study", "plan"], &options[..]].concat(), &["--dir", twice]);
    }
    refuses_in_a_line(&["study", "plan", "counts", "--rays", "64", "--quick", "--quick"], &["--quick", twice]);
}

#[test]
fn jobs_of_threads_say_up_to_how_many_whatever_cores_their_machine_has() {
    let folder = TempDir::new().unwrap();
    let cores = std::thread::available_parallelism().unwrap().get();
    let most = |args: &[&str]| -> Vec<Vec<String>> {
        let lines = plan(folder.path(), &[&["threads", "--scenes", "cube"][..], args].concat());
        let of = |line: &String| -> Vec<String> {
            let words = words(line);
            let pairs = words.windows(2).filter(|pair| pair[0] == "--most");
            pairs.map(|pair| pair[1].clone()).collect()
        };
        lines.iter().map(of).collect()
    };
    assert_eq!(most(&["--epochs", "1", "--most", "2"]), [["2"], ["2"]], "with one thread and with two");
    if cores > 1 {
        for args in [&["--epochs", "1"][..], &["--quick"]] {
            let most = most(args);
            assert!(!most.is_empty() && most.iter().all(|most| *most == [cores.to_string()]), "{most:?}");
        }
    }
}

#[test]
fn jobs_in_any_order_are_the_study() {
    let folder = TempDir::new().unwrap();
    let [apart, one] = ["apart", "one"].map(|name| folder.path().join(name));
    let lines = plan(&apart, &[&SMALL[..], &SCENES].concat());
    // The last one first.
    lines.iter().rev().for_each(|line| done(line));
    let study = |dir: &Path, more: &[&str]| {
        let own = ["study", "attribution", "cube", "sphere", "--dir", dir.to_str().unwrap()];
        prints(&[&own[..], &SMALL[1..], more].concat())
    };
    study(&one, &["--in-process"]);
    assert_eq!(answers(&apart, "attribution").len(), 4);
    assert_eq!(answers(&apart, "attribution"), answers(&one, "attribution"));

    // They are the journal of the study: it has nothing left to measure, and changes nothing.
    let before: Vec<Vec<u8>> = lines.iter().map(|line| fs::read(file(line)).unwrap()).collect();
    assert!(study(&apart, &[]).contains("Cube"));
    assert_eq!(lines.iter().map(|line| fs::read(file(line)).unwrap()).collect::<Vec<_>>(), before);
    assert_eq!(fs::read_dir(apart.join("attribution")).unwrap().count(), 4);

    // Each says where it comes from, and names the run and not the job.
    let case = json(file(&lines[0]));
    for field in ["host", "cpu", "commit", "target_features", "date", "command"] {
        assert!(!case["provenance"][field].as_str().unwrap().is_empty(), "{field}");
    }
    let command = case["provenance"]["command"].as_str().unwrap();
    assert!(command.ends_with("study attribution cube sphere --rays 64 --runs 1 --budget 1 --epochs 2"), "{command}");
}

#[test]
fn detailed_studies_and_whole_scenes_are_jobs_as_well() {
    let folder = TempDir::new().unwrap();
    let [apart, one] = ["apart", "one"].map(|name| folder.path().join(name));
    let own = ["-s", "sah-kd", "-s", "sah-bvh", "-w", "diffuse", "--rays", "256", "--epochs", "2", "--budget", "1"];
    let lines = plan(&apart, &[&["compare"][..], &["--scenes", "cube", "torus"], &own].concat());
    assert_eq!(lines.len(), 4);
    lines.iter().rev().for_each(|line| done(line));
    let dir = one.to_str().unwrap();
    prints(&[&["compare", "cube", "torus", "--dir", dir][..], &own].concat());
    assert_eq!(answers(&apart, "compare"), answers(&one, "compare"));

    let lines = plan(&apart, &["counts", "--scenes", "cube", "-s", "sah-kd", "-w", "primary", "--rays", "100"]);
    assert_eq!(lines.len(), 1);
    done(&lines[0]);
    assert_eq!(json(file(&lines[0]))["study"], "counts");
}

#[test]
fn predictions_are_jobs_as_well_and_a_report_has_their_verdicts() {
    let folder = TempDir::new().unwrap();
    let [runs, page, export] = ["runs", "page", "export.json"].map(|name| folder.path().join(name));
    let lines = plan(&runs, &["predictions"]);
    assert_eq!(lines.len(), 9, "the easy and normal scenes of the report");
    done(&lines[0]);
    // The others take longer: as if they had as many rays.
    let counted = json(file(&lines[0]));
    for line in &lines[1..] {
        let words = words(line);
        let job = words.iter().find_map(|word| word.strip_prefix("--case=")).unwrap();
        let job: Value = serde_json::from_str(job).unwrap();
        let mut case = counted.clone();
        (case["key"], case["case"]["scene"]) = (job["key"].clone(), job["scene"].clone());
        fs::write(file(line), case.to_string()).unwrap();
    }
    let [dir, page_name, export_name] = [&runs, &page, &export].map(|path| path.to_str().unwrap());
    prints(&["study", "predictions", "--dir", dir, "--export-json", export_name]);
    prints(&["report", dir, "--no-pictures", "-o", page_name]);

    let verdict = |claim: &Value| claim["verdict"].as_str().unwrap().to_owned();
    let answer = json(&export)["result"].take();
    let claims = answer.as_array().unwrap().iter().flat_map(|prediction| prediction["claims"].as_array().unwrap());
    let answered: Vec<String> = claims.map(verdict).collect();
    let rows = fs::read_to_string(page.join("data/predictions.jsonl")).unwrap();
    let shown: Vec<String> = rows.lines().map(|row| verdict(&serde_json::from_str(row).unwrap())).collect();
    assert_eq!(shown, answered);
    assert!(shown[..8].iter().all(|verdict| verdict == "confirmed"), "{shown:?}");
}

#[test]
fn the_report_keeps_machines_apart_and_names_what_is_missing() {
    let folder = TempDir::new().unwrap();
    let [here, there, page] = ["here", "there", "page"].map(|name| folder.path().join(name));
    let own = ["-s", "sah-kd", "-s", "obvhs-bvh2", "-w", "primary", "--rays", "256", "--epochs", "2", "--budget", "1"];
    let planned = |dir: &Path| plan(dir, &[&["compare", "--scenes", "cube", "torus"][..], &own].concat());
    let lines = planned(&here);
    lines.iter().for_each(|line| done(line));
    // A plan that is kept beside the results tells how many there are to be.
    let never = lines[0].replace("epoch-0", "epoch-9");
    fs::write(here.join("plan.txt"), [&lines[..], &[never]].concat().join("\n")).unwrap();
    // As another machine would have measured them, but for one.
    fs::create_dir_all(there.join("compare")).unwrap();
    for (i, line) in planned(&here).iter().enumerate().filter(|(i, _)| *i != 2) {
        let mut case = json(file(line));
        case["provenance"]["cpu"] = "Another Processor".into();
        fs::write(there.join(format!("compare/{i}.json")), case.to_string()).unwrap();
    }
    let report = |more: &[&Path]| {
        let mut args = vec!["report", "--no-pictures", "-o", page.to_str().unwrap()];
        args.extend(more.iter().map(|path| path.to_str().unwrap()));
        sahara(&args)
    };
    let output = report(&[&here, &there]);
    assert_eq!(output.status.code(), Some(RIGHT), "{}", stderr(&output));
    let told = stdout(&output);
    assert!(told.contains("compare: ") && told.contains("not measured"), "{told}");
    assert!(told.contains("1 of 5 jobs of ") && told.contains("epoch-9"), "{told}");
    let html = fs::read_to_string(page.join("index.html")).unwrap();
    assert!(html.contains("Another Processor") && html.contains("M2"), "two machines, side by side");
    let records = fs::read_to_string(page.join("data/records.jsonl")).unwrap();
    assert!(!records.contains("Another Processor") && records.lines().count() == 4, "{records}");

    // Conflicting settings are refused by the names of settings and files.
    let other: Vec<String> = planned(&there).iter().map(|line| line.replace("--rays 256", "--rays 64")).collect();
    done(&other[2]);
    let output = report(&[&here, &there]);
    refused_in_a_line(&output, &["rays is 256 in the first and 64 in the second"]);
    assert_eq!(stderr(&output).matches(".json").count(), 2, "{}", stderr(&output));
}

#[test]
fn a_plan_takes_no_option_that_writes_what_came_of_a_study() {
    for option in [&["--export-json", "x.json"][..], &["--export-csv=x.csv"], &["--plot", "x.svg"]] {
        refuses_in_a_line(&[&["study", "plan"], &SMALL[..], option].concat(), &["--", "once all jobs are done"]);
    }
    let after_scenes = ["study", "plan", "attribution", "--scenes", "cube", "--plot", "x.svg"];
    refuses_in_a_line(&after_scenes, &["--plot", "once all jobs are done"]);
    // A job that finds its case measures nothing, whatever is asked.
    refuses_in_a_line(&[&["study", "plan"], &SMALL[..], &["--fresh"]].concat(), &["--fresh", "--dir"]);
}

#[test]
fn a_study_that_is_named_twice_is_planned_once() {
    let folder = tempfile::tempdir().unwrap();
    let planned = |names: &[&str]| plan(folder.path(), &[names, &["--scenes", "cube"]].concat());
    assert_eq!(planned(&["counts", "counts"]), planned(&["counts"]));
    // Scenes are added up, as everywhere.
    let torus = ["counts", "--scenes", "torus"];
    assert_eq!(planned(&torus), plan(folder.path(), &[&torus[..], &["cube"]].concat()));
}
