//! Tests the output, exports and figures of `sahara study`.

use serde_json::Value;

use super::command::{Folder, RIGHT, assert_contains, json, refused_in_a_line};
use super::journal;

#[test]
fn accuracy_prints_exports_and_draws_what_it_finds() {
    let folder = Folder::new();
    let printed = folder.prints(
        "study accuracy cube --rays 300 --runs 2 --budget 1 --workload vertex --workload uniform -s sah-kd -t exact \
         -t moller-trumbore --export-json a.json --plot a.svg --dir runs",
    );
    assert_contains(&printed, &["vertex: 300 rays through vertices", "uniform: 300 camera rays and random lines"]);
    assert_contains(&printed, &[":test=moller-trumbore", "dominated by"]);
    let rows = journal::rows(folder.path("a.json"));
    assert_eq!(rows.len(), 4, "{rows:?}");
    let wrong = |row: &Value| ["missed", "false_hits", "wrong_depth"].map(|kind| row["errors"][kind].as_u64().unwrap());
    let exact: Vec<&Value> = rows.iter().filter(|row| row["triangle_test"] == "exact").collect();
    assert_eq!(exact.len(), 2);
    assert!(exact.iter().all(|row| wrong(row) == [0; 3] && row["errors"]["rays"] == 300), "{rows:?}");
    // The provenance contains the command of the study, not the command of a child process.
    let provenance = &json(folder.path("a.json"))["provenance"];
    assert_eq!(provenance["process_per_epoch"], true);
    assert!(!provenance["command"].as_str().unwrap().contains("--case"), "{provenance}");
    assert!(folder.read("a.svg").contains("moller-trumbore"));
}

#[test]
fn more_threads_than_cores_are_warned_of() {
    let cores = std::thread::available_parallelism().unwrap().get();
    for (threads, is_warned) in [(cores + 1, true), (cores, false)] {
        let line = format!("compare cube --rays 400 -w primary -s sah-kd --runs 2 --epochs 1 --threads {threads}");
        let [_, messages] = Folder::new().ends(RIGHT, &line);
        let warning = format!("warning: {threads} threads share {cores} core");
        assert_eq!(messages.contains(&warning), is_warned, "{messages}");
    }
}

#[test]
fn real_meshes_that_are_asked_for_are_never_replaced() {
    let folder = Folder::new();
    let mut command = folder.command("--quiet study attribution cube dragon --meshes real");
    refused_in_a_line(command.env("SAHARA_DATA", "."), &["real meshes of Dragon are missing: `sahara fetch`"]);
}
