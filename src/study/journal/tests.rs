use std::fs;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::*;
use crate::measure::Provenance;

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
struct Case {
    samples: Vec<f64>,
}

fn read(value: &serde_json::Value) -> serde_json::Result<Case> {
    Case::deserialize(value)
}

fn case(i: u32) -> Case {
    Case { samples: vec![f64::from(i), 0.1 + f64::from(i) / 3.0] }
}

fn header(runs: u32) -> Header {
    let mut provenance = Provenance::capture(1);
    provenance.commit = "c0ffee".into();
    Header::new("tiny", &serde_json::json!({ "runs": runs, "workload": "primary" }), provenance)
}

fn open(path: &Path) -> Result<Journal<Case>, JournalError> {
    Journal::open(path, header(5), false, read)
}

/// A journal of `n` cases in a folder that is not there before.
fn journal(folder: &tempfile::TempDir, n: u32) -> PathBuf {
    let path = folder.path().join("runs/tiny");
    let mut journal = open(&path).unwrap();
    for i in 0..n {
        journal.append(&format!("case {i}"), case(i)).unwrap();
    }
    path
}

fn folder() -> tempfile::TempDir {
    tempfile::tempdir().unwrap()
}

fn sentence(error: JournalError, parts: &[&str]) {
    let text = error.to_string();
    assert_eq!(text.lines().count(), 1, "{text}");
    for part in parts {
        assert!(text.contains(part), "{part:?} is not in {text:?}");
    }
}

fn contents(folder: &Path) -> Vec<(PathBuf, Vec<u8>)> {
    let mut found: Vec<PathBuf> = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    found.sort();
    found.into_iter().map(|path| (path.clone(), fs::read(path).unwrap())).collect()
}

#[test]
fn what_was_appended_is_there_when_opened_again() {
    let folder = folder();
    let path = journal(&folder, 3);
    assert_eq!(contents(&path).len(), 3, "one file a case");
    let again = open(&path).unwrap();
    assert_eq!(["case 0", "case 1", "case 2"].map(|key| again.get(key).cloned()), [0, 1, 2].map(|i| Some(case(i))));
    assert_eq!(again.left(["case 2", "case 3"]), ["case 3"]);
}

#[test]
fn names_of_files_are_plain_and_of_one_key_alone() {
    let keys = [
        "Cube 0123 epoch 0",
        "cube 0123 epoch 0",
        "Cube 0123 epoch 00",
        "r=10 @1e5",
        "\u{fc}",
        "",
        "a b",
        "a-b",
        "a--b",
    ];
    let mut names: Vec<String> = keys.iter().map(|key| file_name(key)).collect();
    assert!(names[0].starts_with("cube-0123-epoch-0-"), "{names:?}");
    names.push(file_name(&"long ".repeat(100)));
    for name in &names {
        let case = name.strip_suffix(".json").unwrap();
        assert!(case.chars().all(|c| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '-'), "{name}");
        assert!(!case.is_empty() && name.len() < 128, "{name}");
    }
    let count = names.len();
    names.sort();
    names.dedup();
    assert_eq!(names.len(), count);
}

#[test]
fn what_is_being_written_is_no_case() {
    let folder = folder();
    let path = journal(&folder, 2);
    fs::write(path.join(".sahara-1234.part"), b"{\"schema\":3,\"stu").unwrap();
    assert_eq!(open(&path).unwrap().left(["case 0", "case 1", "case 2"]), ["case 2"]);
}

#[test]
fn other_settings_are_refused_with_what_differs_and_the_way_out() {
    let folder = folder();
    let path = journal(&folder, 1);
    let before = contents(&path);
    let other = Journal::<Case>::open(&path, header(7), false, read).unwrap_err();
    sentence(other, &["case-0", "runs was 5 and is 7", "--fresh", "--dir"]);
    let mut more = header(5);
    more.settings.insert("seed".into(), 1.into());
    sentence(Journal::<Case>::open(&path, more, false, read).unwrap_err(), &["seed was not there and is 1"]);
    let mut all = header(5);
    all.settings.insert("rays".into(), usize::MAX.into());
    sentence(Journal::<Case>::open(&path, all, false, read).unwrap_err(), &["rays was not there and is all"]);
    let mut study = header(5);
    study.study = "other".into();
    sentence(Journal::<Case>::open(&path, study, false, read).unwrap_err(), &["the study tiny, not of other"]);
    // Nothing of this has changed the journal.
    assert_eq!(contents(&path), before);
    assert_eq!(Journal::<Case>::open(&path, header(7), true, read).unwrap().left(["case 0"]), ["case 0"]);
    assert!(contents(&path).is_empty());
}

#[test]
fn another_build_or_processor_is_refused_and_another_host_goes_on() {
    let folder = folder();
    let path = journal(&folder, 2);
    let with = |change: fn(&mut Provenance)| {
        let mut other = header(5);
        change(&mut other.provenance);
        Journal::<Case>::open(&path, other, false, read)
    };
    sentence(with(|p| p.commit = "decade".into()).unwrap_err(), &["commit was c0ffee and is decade", "sahara report"]);
    sentence(with(|p| p.build = "0123".into()).unwrap_err(), &["build was ", " and is 0123", "--fresh"]);
    sentence(with(|p| p.cpu = "another".into()).unwrap_err(), &["cpu was ", " and is another", "--fresh"]);
    // The command line, the load and the name of the machine are no reason.
    let mut same = with(|p| (p.command, p.host) = ("sahara study tiny -q".into(), "node2".into())).unwrap();
    same.append("case 2", case(2)).unwrap();
    assert_eq!(open(&path).unwrap().left(["case 0", "case 1", "case 2"]), [""; 0]);
}

#[test]
fn the_provenance_is_that_of_the_oldest_case() {
    let folder = folder();
    let path = folder.path().join("tiny");
    for (key, date) in [("b", "2026-01-02T00:00:00Z"), ("a", "2026-01-03T00:00:00Z"), ("c", "2026-01-01T00:00:00Z")] {
        let mut own = header(5);
        own.provenance.date = date.into();
        Journal::open(&path, own, false, read).unwrap().append(key, case(0)).unwrap();
    }
    assert_eq!(open(&path).unwrap().provenance().date, "2026-01-01T00:00:00Z");
}

#[test]
fn of_two_writers_of_a_case_the_first_wins_and_both_go_on_with_it() {
    let folder = folder();
    let path = journal(&folder, 1);
    let [mut one, mut other] = [open(&path).unwrap(), open(&path).unwrap()];
    one.append("case 1", case(1)).unwrap();
    other.append("case 1", case(9)).unwrap();
    assert_eq!((one.get("case 1"), other.get("case 1")), (Some(&case(1)), Some(&case(1))));
    assert_eq!(contents(&path).len(), 2);
    // Of other settings it is refused.
    let mut third = Journal::<Case>::in_memory(header(7), read);
    third.folder = Some(path);
    sentence(third.append("case 1", case(1)).unwrap_err(), &["runs was 5 and is 7"]);
}

#[cfg(unix)]
#[test]
fn one_run_at_a_time_measures_and_others_may_look() {
    let folder = folder();
    let path = journal(&folder, 2);
    let run = |fresh: bool, keys: &[&str]| {
        Journal::<Case>::open_to_measure(&path, header(5), fresh, read, keys.iter().copied())
    };
    let (measured, missing) = (["case 0", "case 1"], ["case 1", "case 2"]);
    let mut one = run(false, &missing).unwrap();
    sentence(run(false, &missing).unwrap_err(), &["another run", "runs/tiny", "when it has ended", "--dir"]);
    sentence(run(true, &measured).unwrap_err(), &["another run"]);
    // What measures nothing throws nothing away, and holds up nobody.
    let look = run(false, &measured).unwrap();
    one.append("case 2", case(2)).unwrap();
    assert_eq!((look.left(measured).len(), contents(&path).len()), (0, 3));
    drop(one);
    let again = run(false, &["case 3"]).unwrap();
    assert_eq!(again.get("case 2"), Some(&case(2)));
    drop(again);
    assert!(run(true, &[]).unwrap().left(measured).len() == 2 && contents(&path).is_empty());
}

#[test]
fn what_is_no_case_is_left_alone() {
    let folder = folder();
    let path = journal(&folder, 0);
    for (text, part) in [("my notes", "does not read"), ("{\"a\":1}", "not a case of a study"), ("[]", "not a case")] {
        fs::write(path.join("notes.json"), text).unwrap();
        sentence(open(&path).unwrap_err(), &["notes.json", part]);
        assert_eq!(fs::read_to_string(path.join("notes.json")).unwrap(), text);
    }
    fs::write(path.join("notes.json"), "{\"schema\":2,\"study\":\"tiny\",\"settings\":{},\"provenance\":{}}").unwrap();
    sentence(open(&path).unwrap_err(), &["version 2", "version 3", "--fresh"]);
    sentence(open(&path.join("notes.json")).unwrap_err(), &["cannot write", "--dir"]);
}

#[test]
fn a_case_in_two_files_is_refused_by_both_names() {
    let folder = folder();
    let path = journal(&folder, 1);
    fs::copy(path.join(file_name("case 0")), path.join("again.json")).unwrap();
    sentence(open(&path).unwrap_err(), &["again.json", "case-0", "the same case \"case 0\""]);
}

#[test]
fn damage_is_named_with_what_is_wrong() {
    let folder = folder();
    let path = journal(&folder, 1);
    let file = path.join(file_name("case 0"));
    let text = fs::read_to_string(&file).unwrap();
    fs::write(&file, &text[..text.len() / 2]).unwrap();
    sentence(open(&path).unwrap_err(), &["case-0", "does not read: EOF", "remove it"]);
    fs::write(&file, text.replace("\"samples\"", "\"times\"")).unwrap();
    sentence(open(&path).unwrap_err(), &["case-0", "missing field `samples`"]);
}

#[test]
fn a_file_is_there_for_its_own_case_alone() {
    let folder = folder();
    let path = journal(&folder, 1).join(file_name("case 0"));
    let there = |runs, key| CaseFile::<Case>::there(&path, &header(runs), key, read);
    assert_eq!(there(5, "case 0").unwrap().unwrap().case, case(0));
    sentence(there(5, "case 1").unwrap_err(), &["holds the case \"case 0\", not \"case 1\""]);
    sentence(there(7, "case 0").unwrap_err(), &["runs was 5 and is 7"]);
    fs::remove_file(&path).unwrap();
    assert!(there(5, "case 0").unwrap().is_none());
}

#[test]
fn what_was_kept_in_memory_can_be_kept_in_a_folder() {
    let folder = folder();
    let path = folder.path().join("unfinished/tiny-1");
    let mut journal = Journal::in_memory(header(5), read);
    journal.append("case 0", case(0)).unwrap();
    journal.keep(&path).unwrap();
    assert_eq!(open(&path).unwrap().get("case 0"), Some(&case(0)));
    // Another run of the same cases, interrupted later, adds what is not there.
    let mut other = Journal::in_memory(header(5), read);
    other.append("case 0", case(9)).unwrap();
    other.append("case 1", case(1)).unwrap();
    other.keep(&path).unwrap();
    let both = open(&path).unwrap();
    assert_eq!(["case 0", "case 1"].map(|key| both.get(key).cloned()), [0, 1].map(|i| Some(case(i))));
}

#[test]
#[should_panic(expected = "measured twice")]
fn a_case_is_measured_once() {
    let folder = folder();
    let path = journal(&folder, 1);
    let _ = open(&path).unwrap().append("case 0", case(0));
}

#[test]
#[should_panic(expected = "does not read back")]
fn a_case_that_would_not_read_back_is_not_written() {
    let folder = folder();
    let path = journal(&folder, 1);
    let _ = open(&path).unwrap().append("case 1", Case { samples: vec![f64::NAN] });
}

#[test]
fn what_cannot_be_written_is_one_sentence_and_loses_nothing() {
    let folder = folder();
    let path = journal(&folder, 1);
    let mut journal = open(&path).unwrap();
    let before = contents(&path);
    // A folder that takes no file: a file stands where it was.
    let moved = path.with_extension("moved");
    fs::rename(&path, &moved).unwrap();
    fs::write(&path, b"x").unwrap();
    sentence(journal.append("case 1", case(1)).unwrap_err(), &["cannot write", "case-1", "kept", "--dir"]);
    fs::remove_file(&path).unwrap();
    fs::rename(&moved, &path).unwrap();
    assert_eq!((contents(&path), journal.left(["case 1"]).len()), (before, 1));
    journal.append("case 1", case(1)).unwrap();
}

#[test]
fn of_a_scene_that_has_changed_the_last_version_counts() {
    let file = |key: &str, date: &str| {
        let mut header = header(5);
        header.provenance.date = date.into();
        CaseFile { path: key.into(), header, key: key.into(), case: () }
    };
    let files = [
        file("Dragon (stand-in) 00000000000000aa epoch 0", "2026-01"),
        file("Dragon 00000000000000bb epoch 0", "2026-03"),
        file("Dragon 00000000000000cc epoch 0", "2026-02"),
        file("Dragon 00000000000000cc epoch 1", "2026-02"),
        file("r=10 @1e5", "2026-01"),
        // Begun later, and not to be answered yet.
        file("Dragon 00000000000000dd epoch 1", "2026-04"),
    ];
    let of = |both_meshes: bool| {
        let (kept, notes) = newest(&files, both_meshes);
        let is_kept = |i: &usize| kept.iter().any(|file| file.key == files[*i].key);
        ((0..files.len()).filter(is_kept).collect::<Vec<_>>(), notes.join(" "))
    };
    assert_eq!(of(false), (vec![1, 4], "Dragon: left out, for another version is shown: 4 cases.".into()));
    assert_eq!(of(true), (vec![0, 1, 4], "Dragon: left out, for another version is shown: 3 cases.".into()));
}

#[test]
fn cases_of_builds_and_machines_are_apart_and_those_of_hosts_are_not() {
    let file = |key: &str, host: &str, commit: &str, date: &str| {
        let mut header = header(5);
        let p = &mut header.provenance;
        (p.host, p.commit, p.date) = (host.into(), commit.into(), date.into());
        (p.threads, p.load) = (1, Some(if host == "n3" { 9.0 } else { 0.5 }));
        CaseFile { path: format!("{key}-{host}-{commit}").into(), header, key: key.into(), case: () }
    };
    let files = vec![
        file("a", "n1", "new", "2026-03"),
        file("a", "n1", "old", "2026-01"),
        file("b", "n2", "new", "2026-02"),
        file("a", "n3", "new", "2026-04"),
    ];
    let found = groups(files.clone()).unwrap();
    let of =
        |group: &Group<()>| -> Vec<String> { group.files.iter().map(|file| file.path.display().to_string()).collect() };
    assert_eq!(found.iter().map(of).collect::<Vec<_>>(), [vec!["a-n1-old"], vec!["a-n3-new", "b-n2-new"]]);
    assert_eq!(found[1].replaced, [PathBuf::from("a-n1-new")]);
    let of_all = &found[1].provenance;
    assert_eq!((of_all.date.as_str(), of_all.host.as_str()), ("2026-02", "n3, n2"));
    assert_eq!((found[0].provenance.load, of_all.load), (Some(0.5), Some(9.0)));
    // Less what the job before it has made.
    let after = CaseFile { key: "c".into(), ..file("c", "n3", "new", "2026-05") };
    let mut before = file("a", "n3", "new", "2026-04");
    before.header.provenance.load = None;
    let found = groups(vec![after, before]).unwrap();
    assert_eq!(found[0].provenance.load, Some(8.0));

    let mut other = files;
    other[1].header.settings.insert("runs".into(), 6.into());
    let Err(error) = groups(other) else { panic!("they are mixed") };
    sentence(error, &["a-n1-new", "a-n1-old", "the study tiny", "runs is 5 in the first and 6 in the second"]);
}
