use std::fs;

use super::*;
use crate::report::timed_example;

const EPOCHS: usize = 6;

/// A case with `ns` a sample, but for what an epoch adds.
fn record(label: &str, commit: &str, ns: f64) -> Record {
    let epoch = |e: usize| 1.0 + 0.002 * (e as f64 - 2.5);
    let samples_ns: Vec<f64> = (0..EPOCHS).flat_map(|e| [ns * epoch(e); 3]).collect();
    let record = timed_example(label, "primary", &samples_ns, EPOCHS);
    Record { provenance: Provenance { commit: commit.into(), ..record.provenance }, ..record }
}

/// A run on a machine that is `slow` times as slow, in which the SAH tree takes `sah` times its time.
fn run(commit: &str, slow: f64, sah: f64) -> Entry {
    let of = [("sah-kd", 2e6 * sah), ("median-kd", 9e6), ("obvhs-bvh2", 1e6)];
    Entry::new("main", &of.map(|(label, ns)| record(label, commit, ns * slow))).unwrap()
}

#[test]
fn what_is_kept_is_relative_to_obvhs() {
    let one = run("a", 1.0, 1.0);
    assert_eq!((one.references.len(), one.structures.len()), (1, 2));
    let speed = one.structures[0].speed().unwrap();
    assert!((speed.estimate - 0.5).abs() < 1e-9 && one.structures[0].label == "sah-kd", "{speed:?}");
    let slow = run("a", 3.0, 1.0).structures[0].speed().unwrap();
    assert!((slow.estimate - 0.5).abs() < 1e-9, "a slow machine is no slow structure: {slow:?}");
    assert_eq!(Entry::new("main", &[record("sah-kd", "a", 1e6)]), None, "nothing to relate it to");
    assert_eq!(Entry::new("main", &[record("obvhs-bvh2", "a", 1e6)]), None, "nothing to keep");
}

#[test]
fn changes_that_are_real_are_found_and_others_are_not() {
    let all =
        series(&[run("a", 1.0, 1.0), run("b", 1.2, 1.0), run("c", 0.9, 1.1), run("d", 1.0, 1.1), run("e", 1.0, 0.9)]);
    assert_eq!(all.len(), 1);
    let found: Vec<(&str, usize)> = all[0].changes.iter().map(|step| (step.structure.as_str(), step.run)).collect();
    assert_eq!(found, [("sah-kd", 2), ("sah-kd", 4)]);
    assert!(all[0].changes[0].time.is_above(1.0) && all[0].changes[1].time.is_below(1.0));
    assert!((all[0].changes[0].time.estimate - 1.1).abs() < 1e-6);
    assert_eq!(all[0].structures(), ["sah-kd", "median-kd"]);
    assert!((all[0].speed(4, "sah-kd").unwrap().estimate - 0.5 / 0.9).abs() < 1e-9);
}

#[test]
fn what_cannot_be_compared_is_another_series_or_no_change() {
    let mut elsewhere = run("b", 1.0, 2.0);
    elsewhere.provenance.cpu = "another processor".into();
    let renamed = Entry { baseline: "other".into(), ..run("b", 1.0, 2.0) };
    let mut other_rays = run("b", 1.0, 2.0);
    other_rays.structures.iter_mut().for_each(|one| one.rays = "0".into());
    let all = series(&[run("a", 1.0, 1.0), elsewhere, renamed, other_rays]);
    assert_eq!(all.iter().map(|one| one.runs.len()).collect::<Vec<_>>(), [2, 1, 1]);
    assert!(all.iter().all(|one| one.changes.is_empty()), "other rays are no change of a structure");
}

#[test]
fn runs_that_no_baseline_is_held_against_are_another_series() {
    let changes: [fn(&mut Provenance); 5] = [
        |p| p.process_per_epoch ^= true,
        |p| p.clock += " or another",
        |p| p.target += "-other",
        |p| p.target_features += ",other",
        |p| p.threads += 1,
    ];
    for change in changes {
        let mut other = run("b", 1.0, 2.0);
        change(&mut other.provenance);
        let all = series(&[run("a", 1.0, 1.0), other]);
        assert!(all.len() == 2 && all.iter().all(|one| one.changes.is_empty()), "{:?}", all[1].runs[0].provenance);
    }
}

#[test]
fn a_file_holds_one_run_a_commit_and_machine() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(FILE);
    assert_eq!(read(&path).unwrap(), []);
    let runs = [run("a", 1.0, 1.0), run("b", 1.0, 1.0), run("c+changes", 1.0, 1.0), run("c+changes", 1.0, 1.1)];
    runs.iter().for_each(|run| add(&path, run.clone()).unwrap());
    assert_eq!(read(&path).unwrap(), runs, "in order, as they were");
    // Again, and from another machine.
    let again = run("b", 1.0, 1.3);
    let mut elsewhere = run("a", 1.0, 1.0);
    elsewhere.provenance.cpu = "another processor".into();
    add(&path, again.clone()).unwrap();
    add(&path, elsewhere.clone()).unwrap();
    let [a, _, c, changed] = runs;
    assert_eq!(read(&path).unwrap(), [a, again, c, changed, elsewhere], "the order of commits stays");
    assert_eq!(fs::read_to_string(&path).unwrap().lines().count(), 5);
}

#[cfg(unix)]
#[test]
fn of_machines_that_add_at_once_none_is_lost() {
    let folder = tempfile::tempdir().unwrap();
    let path = &folder.path().join(FILE);
    let runs: Vec<Entry> = (0..8).map(|i| run(&format!("c{i}"), 1.0, 1.0)).collect();
    std::thread::scope(|scope| {
        for run in &runs {
            scope.spawn(move || add(path, run.clone()).unwrap());
        }
    });
    assert_eq!(read(path).unwrap().len(), runs.len());
}

#[test]
fn a_line_that_does_not_read_is_named_and_nothing_is_lost() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(FILE);
    add(&path, run("a", 1.0, 1.0)).unwrap();
    let whole = fs::read_to_string(&path).unwrap();
    let newer = whole.replace("\"schema\":1", "\"schema\":9");
    let torn = &whole[..20];
    for (line, words) in [("{\"schema\":1}\n", "line 2"), (&*newer, "version 9"), (torn, "line 2")] {
        fs::write(&path, format!("{whole}{line}")).unwrap();
        let told = add(&path, run("b", 1.0, 1.0)).unwrap_err().to_string();
        assert!(told.contains(words) && told.contains("history.jsonl") && told.contains("remove that line"), "{told}");
        assert_eq!(fs::read_to_string(&path).unwrap(), format!("{whole}{line}"));
    }
    fs::write(&path, format!("\n{whole} \n")).unwrap();
    assert_eq!(read(&path).unwrap(), [run("a", 1.0, 1.0)], "a blank line is no run");
}
