use std::fs;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::*;
use crate::measure::Provenance;

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
struct Case {
    samples: Vec<f64>,
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
    Journal::open(path, header(5), false)
}

/// A journal of `n` cases in a folder that is not there before.
fn journal(folder: &tempfile::TempDir, n: u32) -> PathBuf {
    let path = folder.path().join("runs/tiny.jsonl");
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

#[test]
fn what_was_appended_is_there_when_opened_again() {
    let folder = folder();
    let path = journal(&folder, 3);
    let again = open(&path).unwrap();
    assert_eq!(again.cases(), [case(0), case(1), case(2)]);
    assert_eq!(again.get("case 1"), Some(&case(1)));
    assert_eq!(again.left(["case 2", "case 3"]), ["case 3"]);
    drop(again);
    let read = Journal::<Case>::read(&path, "tiny").unwrap();
    assert_eq!((read.header, read.cases.len()), (header(5), 3));
}

#[test]
fn a_journal_cut_anywhere_goes_on_with_its_whole_lines_and_ends_the_same() {
    let folder = folder();
    let path = journal(&folder, 3);
    let whole = fs::read(&path).unwrap();
    let near_an_end = |length: usize| whole[length.saturating_sub(2)..whole.len().min(length + 1)].contains(&b'\n');
    for length in (0..=whole.len()).filter(|&length| length % 41 == 0 || near_an_end(length)) {
        fs::write(&path, &whole[..length]).unwrap();
        let lines = whole[..length].iter().filter(|&&byte| byte == b'\n').count();
        let mut journal = open(&path).unwrap();
        assert_eq!(journal.cases().len(), lines.saturating_sub(1), "cut to {length} bytes");
        for i in 0..3 {
            if journal.get(&format!("case {i}")).is_none() {
                journal.append(&format!("case {i}"), case(i)).unwrap();
            }
        }
        drop(journal);
        assert_eq!(fs::read(&path).unwrap(), whole, "cut to {length} bytes");
    }
}

#[test]
fn a_reader_passes_over_a_line_that_is_being_written() {
    let folder = folder();
    let path = journal(&folder, 2);
    let whole = fs::read(&path).unwrap();
    fs::write(&path, &whole[..whole.len() - 4]).unwrap();
    assert_eq!(Journal::<Case>::read(&path, "tiny").unwrap().cases, [case(0)]);
}

#[test]
fn other_settings_are_refused_with_what_differs_and_the_way_out() {
    let folder = folder();
    let path = journal(&folder, 1);
    let other = Journal::<Case>::open(&path, header(7), false).unwrap_err();
    sentence(other, &["tiny.jsonl", "runs was 5 and is 7", "--fresh", "--dir"]);
    let mut more = header(5);
    more.settings.insert("seed".into(), 1.into());
    let more = Journal::<Case>::open(&path, more, false).unwrap_err();
    sentence(more, &["seed was not there and is 1"]);
    let mut study = header(5);
    study.study = "other".into();
    let study = Journal::<Case>::open(&path, study, false).unwrap_err();
    sentence(study, &["the study tiny, not of other"]);
    sentence(Journal::<Case>::read(&path, "other").unwrap_err(), &["the study tiny, not of other"]);
    // Nothing of this has changed the journal.
    assert_eq!(open(&path).unwrap().cases().len(), 1);
    assert_eq!(Journal::<Case>::open(&path, header(7), true).unwrap().cases().len(), 0);
}

#[test]
fn another_build_may_read_a_journal_but_does_not_take_its_cases_for_its_own() {
    let folder = folder();
    let path = journal(&folder, 2);
    let mut other = header(5);
    other.provenance.commit = "decade".into();
    let refused = Journal::<Case>::open(&path, other, false).unwrap_err();
    sentence(refused, &["commit was c0ffee and is decade", "--fresh", "sahara report"]);
    // The same commit with other changes to it, or with other flags.
    let mut other = header(5);
    other.provenance.build = "0123456789abcdef".into();
    let refused = Journal::<Case>::open(&path, other, false).unwrap_err();
    sentence(refused, &["build was ", " and is 0123456789abcdef", "--fresh"]);
    assert_eq!(Journal::<Case>::read(&path, "tiny").unwrap().cases.len(), 2);
    // The command line and the load of the machine are no reason.
    let mut same = header(5);
    same.provenance.command = "sahara study tiny --quiet".into();
    Journal::open(&path, same, false).unwrap().append("case 2", case(2)).unwrap();
}

#[test]
fn one_process_writes_at_a_time() {
    let folder = folder();
    let path = journal(&folder, 1);
    let first = open(&path).unwrap();
    sentence(open(&path).unwrap_err(), &["tiny.jsonl", "another sahara", "--dir"]);
    // To throw it away is to write, too.
    sentence(Journal::<Case>::open(&path, header(5), true).unwrap_err(), &["another sahara"]);
    assert_eq!(Journal::<Case>::read(&path, "tiny").unwrap().cases.len(), 1);
    drop(first);
    open(&path).unwrap();
}

#[test]
fn what_is_no_journal_is_left_alone() {
    let folder = folder();
    let path = folder.path().join("notes.jsonl");
    for text in ["my notes", "my notes\n", "{\"a\":1}\n", "{\"schema\":1,\"study\":\"tinyish"] {
        fs::write(&path, text).unwrap();
        sentence(open(&path).unwrap_err(), &["notes.jsonl", "not the journal of a study"]);
        assert_eq!(fs::read_to_string(&path).unwrap(), text);
    }
    sentence(open(folder.path()).unwrap_err(), &["it is no regular file"]);
    sentence(open(&path.join("tiny.jsonl")).unwrap_err(), &["cannot write", "--dir"]);
    sentence(
        Journal::<Case>::read(&folder.path().join("none.jsonl"), "tiny").unwrap_err(),
        &["cannot read", "none.jsonl"],
    );
}

#[test]
fn damage_in_the_middle_is_named_by_its_line() {
    let folder = folder();
    let path = journal(&folder, 3);
    let text = fs::read_to_string(&path).unwrap();
    let lines: Vec<&str> = text.lines().collect();
    let write = |lines: &[&str]| fs::write(&path, lines.join("\n") + "\n").unwrap();
    write(&[lines[0], lines[1], "{\"key\":\"case 1\",\"ca", lines[3]]);
    sentence(open(&path).unwrap_err(), &["line 3 of", "tiny.jsonl", "remove that line"]);
    write(&[lines[0], lines[1], "{\"key\":\"case 1\",\"case\":{\"times\":[]}}"]);
    sentence(open(&path).unwrap_err(), &["line 3 of", "samples"]);
    write(&[lines[0], lines[1], lines[1]]);
    sentence(open(&path).unwrap_err(), &["line 3 of", "a second time"]);
    write(&["{\"schema\":1,\"study\":\"tiny\"}"]);
    sentence(open(&path).unwrap_err(), &["line 1 of", "settings"]);
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
    let before = fs::read(&path).unwrap();
    let mut journal = open(&path).unwrap();
    // As on a full disk: the system takes nothing more.
    let good = journal.file.replace(File::open(&path).unwrap());
    sentence(journal.append("case 1", case(1)).unwrap_err(), &["cannot write", "tiny.jsonl", "kept", "--dir"]);
    assert_eq!((fs::read(&path).unwrap(), journal.cases().len()), (before, 1));
    journal.file = good;
    journal.append("case 1", case(1)).unwrap();
    assert_eq!(Journal::<Case>::read(&path, "tiny").unwrap().cases.len(), 2);
}

#[test]
fn a_half_written_line_is_overwritten_by_the_next() {
    let folder = folder();
    let path = journal(&folder, 1);
    let mut journal = open(&path).unwrap();
    // A write that failed half-way, and could not be taken back.
    journal.file.as_mut().unwrap().write_all(&[b'x'; 500]).unwrap();
    journal.append("case 1", case(1)).unwrap();
    assert_eq!(Journal::<Case>::read(&path, "tiny").unwrap().cases, [case(0), case(1)]);
}
