//! Baselines and `diff` from outside: exit statuses and refusals, over runs whose samples are edited, so that no test depends on
//! how fast anything is.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Output;

use serde_json::Value;
use tempfile::TempDir;

use super::command::{NOISE, REGRESSION, RIGHT, SQUARE, USAGE, WRONG, prints, sahara, stderr, stdout};

/// A folder of runs with the baseline `old`.
struct Kept {
    folder: TempDir,
}

impl Kept {
    fn new() -> Self {
        let kept = Self { folder: tempfile::tempdir().unwrap() };
        let output = kept.compare(&["--save-baseline", "old"]);
        assert_eq!(output.status.code(), Some(RIGHT), "{}", stderr(&output));
        assert!(stdout(&output).contains("Kept as baseline old"), "{}", stdout(&output));
        kept
    }

    /// A comparison that takes no time. Fewer rays are answered within microseconds, of which one interruption is a multiple.
    fn compare(&self, more: &[&str]) -> Output {
        let dir = self.folder.path().to_str().unwrap();
        let small =
            ["compare", "cube", "-s", "median-kd", "-s", "sah-kd", "-s", "obvhs-bvh2", "-w", "primary", "-w", "shadow"];
        let short = ["--rays", "16384", "--epochs", "3", "--runs", "2", "--quiet", "--dir", dir];
        sahara(&[&small[..], &short, more].concat())
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join("baselines").join(format!("{name}.json"))
    }

    /// Writes the baseline `old`, edited, under another name.
    fn edit(&self, name: &str, edit: impl Fn(&mut Value)) -> &Self {
        write(&self.path(name), &edited(&self.path("old"), edit));
        self
    }

    /// Holds a new run against a baseline; status, and what is said.
    fn against(&self, name: &str, more: &[&str]) -> (i32, String) {
        let output = self.compare(&[&["--baseline", name], more].concat());
        (output.status.code().unwrap(), stdout(&output) + &stderr(&output))
    }
}

fn edited(path: &Path, edit: impl Fn(&mut Value)) -> Vec<Value> {
    let mut records: Vec<Value> = serde_json::from_slice(&fs::read(path).unwrap()).unwrap();
    records.iter_mut().for_each(edit);
    records
}

fn write(path: &Path, records: &[Value]) {
    fs::write(path, serde_json::to_vec(records).unwrap()).unwrap();
}

/// Multiplies the samples of a structure by `factor` of their place.
fn scale(record: &mut Value, label: &str, factor: impl Fn(usize) -> f64) {
    if record["label"] == label {
        // The twin is the same structure.
        for field in ["samples_ns", "twin_samples_ns"] {
            let samples = record[field].as_array_mut().into_iter().flatten().enumerate();
            samples.for_each(|(i, ns)| *ns = (ns.as_f64().unwrap() * factor(i)).into());
        }
    }
}

#[test]
fn a_regression_noise_and_neither_have_their_statuses() {
    let kept = Kept::new();
    let fail = ["--fail-on-regression", "5"];
    // Far beyond any noise: a thousand times.
    kept.edit("faster", |r| scale(r, "sah-kd", |_| 1e-3)).edit("slower", |r| scale(r, "sah-kd", |_| 1e3));
    let (status, said) = kept.against("faster", &fail);
    assert!(status == REGRESSION && said.contains("regression") && said.contains("obvhs-bvh2"), "{said}");
    let (status, said) = kept.against("faster", &[]);
    assert!(status == RIGHT && said.contains("slower"), "nobody asked to fail: {said}");
    let both = |r: &mut Value| ["sah-kd", "median-kd"].iter().for_each(|label| scale(r, label, |_| 1e3));
    let (status, said) = kept.edit("both", both).against("both", &fail);
    assert!(status == RIGHT && said.contains("faster"), "{said}");

    // Every other epoch, of two samples, a thousand times slower. The other structure is far from its baseline too: unedited, the
    // noise of so short a run could be a regression of its own.
    kept.edit("noisy", |r| {
        scale(r, "sah-kd", |i| if i / 2 % 2 == 0 { 1e3 } else { 1e-3 });
        scale(r, "median-kd", |_| 1e3);
    });
    let (status, said) = kept.against("noisy", &fail);
    assert!(status == NOISE && said.contains("too noisy"), "{said}");
}

#[test]
fn notes_on_the_scenes_are_printed() {
    let folder = tempfile::tempdir().unwrap();
    let (mesh, dir) = (folder.path().join("square.obj"), folder.path().to_str().unwrap());
    fs::write(&mesh, SQUARE).unwrap();
    let small =
        ["compare", mesh.to_str().unwrap(), "-s", "median-kd", "-s", "obvhs-bvh2", "-w", "primary", "--dir", dir];
    for gate in ["--save-baseline", "--baseline"] {
        let said =
            prints(&[&small[..], &["--rays", "256", "--epochs", "2", "--runs", "2", "--quiet", gate, "old"]].concat());
        assert!(said.contains("square: seen from outside, all of it"), "{said}");
    }
}

#[test]
fn other_answers_are_wrong_whatever_the_speed() {
    let kept = Kept::new();
    kept.edit("other", |r| {
        r["answers"] = "0000000000000000".into();
        scale(r, "sah-kd", |_| 1e3);
    });
    let (status, said) = kept.against("other", &["--fail-on-regression", "5", "--save-baseline", "never"]);
    assert!(status == WRONG && said.contains("Wrong: ") && said.contains("primitive"), "{said}");
    assert!(!kept.path("never").exists() && said.contains("Not kept"), "{said}");
    kept.edit("fewer", |r| r["hits"] = (r["hits"].as_u64().unwrap() + 1).into());
    assert_eq!(kept.against("fewer", &[]).0, WRONG);
}

#[test]
fn unlike_runs_are_refused_with_the_difference() {
    let kept = Kept::new();
    let refused = |name: &str, parts: &[&str], edit: &dyn Fn(&mut Value)| {
        let (status, said) = kept.edit(name, edit).against(name, &["--fail-on-regression", "5"]);
        assert_eq!(status, USAGE, "{said}");
        assert!(said.starts_with("error: ") && said.lines().count() == 1, "{said}");
        parts.iter().for_each(|part| assert!(said.contains(part), "{part:?} is not in {said:?}"));
    };
    refused("cpu", &["the processor is Other in the old"], &|r| r["provenance"]["cpu"] = "Other".into());
    refused("label", &["lacks sah-kd on the primary rays of Cube"], &|r| {
        if r["label"] == "sah-kd" {
            r["label"] = "sah-kd:leaf=3".into();
        }
    });
    // The same cases with more of them in the baseline.
    let mut more = edited(&kept.path("old"), |_| {});
    let mut extra = more[0].clone();
    extra["label"] = "median-kd:leaf=3".into();
    more.push(extra);
    write(&kept.path("more"), &more);
    let (status, said) = kept.against("more", &[]);
    assert!(status == USAGE && said.contains("holds median-kd:leaf=3") && said.contains("not compared"), "{said}");
}

#[test]
fn the_baseline_of_another_machine_is_not_replaced() {
    let kept = Kept::new();
    kept.edit("other", |r| r["provenance"]["cpu"] = "Other".into());
    let before = fs::read(kept.path("other")).unwrap();
    let refused = kept.compare(&["--save-baseline", "other"]);
    let said = stderr(&refused);
    assert!(refused.status.code() == Some(USAGE) && said.contains("another machine (Other, "), "{said}");
    assert!(said.contains("other.json") && said.lines().count() == 1, "{said}");
    assert_eq!(fs::read(kept.path("other")).unwrap(), before);
}

#[test]
fn baselines_that_are_not_there_are_named_with_those_that_are() {
    let kept = Kept::new();
    let says = |name: &str, more: &[&str], parts: &[&str]| {
        let (status, said) = kept.against(name, more);
        assert!(status == USAGE && parts.iter().all(|part| said.contains(part)), "{said}");
    };
    says("new", &[], &["\"new\"", "there are: old"]);
    says("../old", &[], &["\"../old\"", "letters"]);
    fs::write(kept.path("torn"), &fs::read(kept.path("old")).unwrap()[..1000]).unwrap();
    says("torn", &[], &["torn.json", "--save-baseline"]);
    says("old", &["--fail-on-regression", "-1"], &["-1"]);
    says("old", &["--fail-on-regression", "much"], &["much"]);
    let alone = kept.compare(&["--fail-on-regression", "5"]);
    assert!(alone.status.code() == Some(USAGE) && stderr(&alone).contains("--baseline"));
    let quick = kept.compare(&["--fail-on-regression", "5", "--quick"]);
    assert!(quick.status.code() == Some(USAGE) && stderr(&quick).contains("--quick"), "{}", stdout(&quick));
    assert!(!stderr(&quick).contains("tip"), "{}", stderr(&quick));
}

#[test]
fn exported_runs_are_compared() {
    let kept = Kept::new();
    let path = |name: &str| kept.path(name).to_str().unwrap().to_owned();
    let compare = |old: &str, new: &str, more: &[&str]| {
        let output = sahara(&[&["diff", &path(old), &path(new)], more].concat());
        (output.status.code().unwrap(), stdout(&output) + &stderr(&output))
    };
    let json = kept.folder.path().join("comparison.json");
    let (status, said) = compare("old", "old", &["--export-json", json.to_str().unwrap()]);
    assert!(status == RIGHT && said.contains("no difference") && said.contains("(100%)"), "{said}");
    let comparison: Value = serde_json::from_slice(&fs::read(&json).unwrap()).unwrap();
    assert_eq!(comparison["study"], "diff");
    let structures = comparison["result"]["structures"].as_array().unwrap();
    assert_eq!((structures.len(), &structures[0]["time"]["estimate"]), (2, &Value::from(1.0)));

    kept.edit("slower", |r| scale(r, "sah-kd", |_| 1e3)).edit("other", |r| r["answers"] = "00".into());
    let (status, said) = compare("old", "slower", &[]);
    assert!(status == RIGHT && said.contains("slower"), "{said}");
    assert_eq!(compare("old", "other", &[]).0, WRONG);
    kept.edit("elsewhere", |r| r["provenance"]["cpu"] = "Other".into());
    let (status, said) = compare("old", "elsewhere", &[]);
    assert!(status == RIGHT && said.contains("Two machines, ") && said.contains("Other ("), "{said}");
    let (status, said) = compare("old", "none", &[]);
    assert!(status == USAGE && said.contains("none.json"), "{said}");
    fs::write(kept.path("empty"), "[]").unwrap();
    fs::write(kept.path("text"), "{}").unwrap();
    assert!(compare("old", "empty", &[]).1.contains("no record"));
    assert!(compare("text", "old", &[]).1.contains("compare --export-json"));
    let (status, said) = compare("old", "slower", &["--export-json", &path("old")]);
    assert!(status == USAGE && said.contains("another"), "nothing that is read is written: {said}");
}

#[test]
fn each_run_that_is_kept_is_a_line_of_the_history_which_the_page_shows() {
    let kept = Kept::new();
    let history = kept.folder.path().join("baselines/history.jsonl");
    let line: Value = serde_json::from_str(fs::read_to_string(&history).unwrap().lines().next().unwrap()).unwrap();
    assert_eq!((&line["baseline"], &line["references"][0]), (&"old".into(), &"obvhs-bvh2".into()));
    assert_eq!(line["structures"][1]["label"], "sah-kd");
    // An older commit, in which the SAH tree took e to the power of 5 times as long.
    let mut older = line.clone();
    older["provenance"]["commit"] = "0ddba11".into();
    let logs = older["structures"][1]["epochs"].as_array_mut().unwrap();
    logs.iter_mut().for_each(|log| *log = (log.as_f64().unwrap() + 5.0).into());
    fs::write(&history, format!("{older}\n{line}\n")).unwrap();
    let page = kept.folder.path().join("page");
    let report = sahara(&["--quiet", "report", history.to_str().unwrap(), "-o", page.to_str().unwrap()]);
    assert_eq!(report.status.code(), Some(RIGHT), "{}", stderr(&report));
    // Where lines break depends on the name of the processor.
    let text = fs::read_to_string(page.join("report.md")).unwrap().split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(text.contains("2 runs kept; in the last one") && text.contains("sah-kd takes 0.0"), "{text}");
    assert!(text.contains("Changes that are real") && text.contains("faster"), "{text}");

    fs::write(&history, "{}\n").unwrap();
    let refused = kept.compare(&["--save-baseline", "old"]);
    assert_eq!(refused.status.code(), Some(USAGE));
    let said = stderr(&refused);
    assert!(said.contains("line 1 of") && said.contains("history.jsonl"), "{said}");
}
