use std::fs;
use std::path::{Path, PathBuf};

use tempfile::TempDir;

use super::*;
use crate::report::words::each_once;
use crate::study::case::tests::example as case;
use crate::study::epoch::tests::example as epoch;

fn provenance() -> Provenance {
    Provenance { commit: "c0ffee".into(), ..Provenance::capture(1) }
}

fn open(path: &Path) -> Result<Journal, JournalError> {
    Journal::open(path, provenance(), false, &[])
}

fn measure(journal: &mut Journal, case: &Case, date: &str) -> PathBuf {
    let provenance = Provenance { date: date.into(), ..journal.provenance.clone() };
    let path = journal.place(case);
    let epoch = epoch(&case.scene.name, 12, case.epoch, &[("x", 50, &[1000; 3])]);
    let file = CaseFile::place(&path).unwrap();
    assert!(CaseFile::write(&file, &provenance, case, &epoch).unwrap());
    journal.add(&path).unwrap();
    path
}

fn journal(folder: &TempDir, n: usize) -> PathBuf {
    let path = folder.path().join("runs/compare");
    let mut journal = open(&path).unwrap();
    (0..n).for_each(|i| drop(measure(&mut journal, &case("Cube", i, &["x"]), "2026-01-01")));
    path
}

fn sentence(error: JournalError, parts: &[&str]) {
    let text = error.to_string();
    assert!(text.lines().count() == 1 && parts.iter().all(|part| text.contains(part)), "{parts:?} is not in {text:?}");
}

#[test]
fn cases_of_other_settings_builds_and_machines_lie_side_by_side() {
    let folder = tempfile::tempdir().unwrap();
    let path = journal(&folder, 1);
    let own = case("Cube", 0, &["x"]);
    let mut slow = own.clone();
    slow.settings.runs = 9;
    let mut journal = open(&path).unwrap();
    assert!(journal.get(&slow).is_none());
    measure(&mut journal, &slow, "2026-01-02");
    assert!(journal.get(&own).is_some() && journal.get(&slow).is_some());
    for change in [|p: &mut Provenance| p.commit = "decade".into(), |p: &mut Provenance| p.cpu = "another".into()] {
        let mut other = provenance();
        change(&mut other);
        let mut journal = Journal::open(&path, other, false, &[]).unwrap();
        assert!(journal.get(&own).is_none(), "another build or machine would measure something else");
        measure(&mut journal, &own, "2026-01-03");
    }
    assert_eq!(files(&path).unwrap().len(), 4, "nothing was thrown away");
    let host = Provenance { host: "elsewhere".into(), load: Some(9.0), ..provenance() };
    assert!(Journal::open(&path, host, false, &[]).unwrap().get(&own).is_some(), "another host goes on");
    // `get` returns the newest file, in this run and in the next run.
    let mut fresh = Journal::open(&path, provenance(), true, &[]).unwrap();
    assert!(fresh.get(&own).is_none());
    let second = measure(&mut fresh, &own, "2026-01-04");
    for journal in [fresh, open(&path).unwrap()] {
        assert_eq!(journal.get(&own).map(|file| &file.path), Some(&second));
    }
}

#[test]
fn names_of_files_are_plain_and_of_one_case_alone() {
    let scenes = ["Cube", "cube", "\u{fc}", "", "a b", "a-b", &"long ".repeat(100)];
    let names = scenes.map(|scene| file_name(&case(scene, 0, &["x"]), &provenance()));
    assert!(names[0].starts_with("cube-epoch-0-"), "{names:?}");
    for name in &names {
        assert!(name.chars().all(|c| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '-'), "{name}");
        assert!(!name.is_empty() && name.len() < 128, "{name}");
    }
    assert_eq!(each_once(&names).len(), names.len(), "{names:?}");
}

#[test]
fn what_is_no_case_or_damaged_is_named_and_left_alone() {
    let folder = tempfile::tempdir().unwrap();
    let path = journal(&folder, 1);
    let file = files(&path).unwrap().remove(0);
    let text = fs::read_to_string(&file).unwrap();
    let old = text.replace("\"schema\":4", "\"schema\":3");
    for (text, parts) in [
        ("my notes", &["cannot be parsed"][..]),
        ("{\"a\":1}", &["not a case of a study"]),
        ("[]", &["not a case"]),
        (&text[..text.len() / 2], &["cannot be parsed: EOF", "remove it"]),
        (&text.replace("\"structures\"", "\"things\""), &["missing field `structures`"]),
        (&old, &["version 3", "version 4"]),
    ] {
        fs::write(&file, text).unwrap();
        sentence(open(&path).unwrap_err(), parts);
        assert_eq!(fs::read_to_string(&file).unwrap(), text);
    }
    sentence(open(&file).unwrap_err(), &["cannot write", "--dir"]);
}

#[test]
fn cases_of_equal_settings_are_a_dataset_and_what_was_measured_again_counts_once() {
    let folder = tempfile::tempdir().unwrap();
    let path = journal(&folder, 2);
    let mut journal = open(&path).unwrap();
    measure(&mut journal, &case("Sphere", 0, &["x"]), "2026-01-01");
    let mut later = case("Cube", 0, &["x", "y"]);
    later.settings.runs = 9;
    measure(&mut journal, &later, "2026-02-01");
    let read = || files(&path).unwrap().iter().map(|path| CaseFile::read(path).unwrap()).collect::<Vec<_>>();
    let scenes = |dataset: &crate::study::Dataset| -> Vec<String> {
        dataset.measured.iter().map(|own| format!("{}{}", own.case.scene.name, own.case.settings.runs)).collect()
    };
    let found = datasets(read());
    let all: Vec<Vec<String>> = found.iter().map(scenes).collect();
    assert_eq!(all, [vec!["Cube3", "Cube3", "Sphere3"], vec!["Cube9"]]);
    let last = newest(read()).unwrap();
    assert_eq!(scenes(&last), ["Cube9"]);
    assert!(last.notes.iter().any(|note| note.starts_with("1 group of cases with other settings")), "{:?}", last.notes);

    let mut elsewhere = open(&path).unwrap();
    elsewhere.provenance.host = "n2".into();
    measure(&mut elsewhere, &later, "2026-03-01");
    let cube = datasets(read()).into_iter().find(|own| own.measured[0].case.settings.runs == 9).unwrap();
    let notes = cube.notes.join(" ");
    assert!(notes.contains("1 case was measured again") && notes.contains("2 hosts"), "{notes}");
    assert!(notes.contains("epoch 1 is not measured"), "{notes}");
}

#[test]
fn provenance_is_of_the_oldest_with_all_hosts_and_the_highest_load_that_no_job_made() {
    let joined = |all: [(&str, &str, Option<f64>); 2]| {
        let of = |(host, date, load): (&str, &str, _)| Provenance {
            host: host.into(),
            date: date.into(),
            load,
            threads: 1,
            ..provenance()
        };
        of_all(&all.map(of).iter().collect::<Vec<_>>())
    };
    let two = joined([("n1", "2026-03", Some(0.5)), ("n2", "2026-02", Some(9.0))]);
    assert_eq!((two.date.as_str(), two.host.as_str(), two.load), ("2026-02", "n1, n2", Some(9.0)));
    let after = joined([("n1", "2026-03", None), ("n1", "2026-04", Some(9.0))]);
    assert_eq!(after.load, Some(8.0), "less what the job before it has made");
}
