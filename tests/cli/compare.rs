//! `sahara compare`: files, winners, colours, odd meshes.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Stdio;

use sahara::render::Picture;

use super::command::{
    RIGHT, SQUARE, command, path_text, prints, refuses, refuses_in_a_line, sahara, small, stderr, stdout, write,
};

/// A warning or, where a run takes long, how far it has come.
fn is_line_of_log(line: &str) -> bool {
    line.starts_with("warning: ") || line.contains(" %: ")
}

#[test]
fn results_go_to_files_that_read_back() {
    let directory = tempfile::tempdir().unwrap();
    let file = |name: &str| path_text(&directory.path().join(name));
    let (json, csv, markdown) = (file("r.json"), file("r.csv"), file("r.md"));
    let mut args = small("Cube");
    args.extend(["--export-json", &json, "--export-csv", &csv, "--export-markdown", &markdown]);
    let output = sahara(&args);
    assert_eq!(output.status.code(), Some(RIGHT), "{}", stderr(&output));
    let told = stderr(&output);
    assert!(told.lines().all(is_line_of_log), "no bar where nobody looks: {told}");

    let records: Vec<serde_json::Value> = serde_json::from_slice(&fs::read(&json).unwrap()).unwrap();
    let ours = ["brute-force", "median-kd", "sah-kd", "sah-kd-wide", "sah-kd-tight", "sah-hybrid", "sah-bvh"];
    let structures = [&ours[..], &["obvhs-bvh2", "obvhs-cwbvh"]].concat();
    assert_eq!(records.len(), structures.len() * 2);
    for (i, record) in records.iter().enumerate() {
        assert_eq!(record["scene"], "Cube");
        assert_eq!(record["triangles"], 12);
        assert_eq!(record["stand_in"], false);
        assert_eq!(record["structure"], structures[i / 2]);
        assert_eq!(record["query"], ["closest", "any"][i % 2]);
        assert_eq!(record["structure_errors"], 0, "{record}");
        assert!(record["trace_ns"].as_f64().unwrap() > 0.0 && record["build_ns"].as_u64().unwrap() > 0, "{record}");
        assert!(record["provenance"]["command"].as_str().unwrap().contains("--export-json"), "{record}");
    }

    let mut reader = csv::Reader::from_path(&csv).unwrap();
    let names = reader.headers().unwrap().clone();
    let fields = records[0].as_object().unwrap();
    // A field of fields has a column for each of them.
    let column = |name: &str, field: &str| name.strip_prefix(field).is_some_and(|r| r.is_empty() || r.starts_with('.'));
    assert!(fields.keys().all(|field| names.iter().any(|name| column(name, field))), "{names:?}");
    assert_eq!(reader.records().map(Result::unwrap).count(), records.len());

    let text = fs::read_to_string(&markdown).unwrap();
    let printed = stdout(&output);
    for structure in structures {
        assert!(text.contains(&format!("| {structure} |")) && printed.contains(structure), "{text}\n{printed}");
    }
    assert!(!printed.contains('\x1b'), "no colour where nobody looks");
    let mut left: Vec<PathBuf> = fs::read_dir(directory.path()).unwrap().map(|entry| entry.unwrap().path()).collect();
    left.sort();
    assert_eq!(left, [&csv, &json, &markdown].map(PathBuf::from), "nothing else is left behind");
}

#[test]
fn a_file_without_camera_is_compared_and_rendered() {
    let directory = tempfile::tempdir().unwrap();
    let square = write(&directory, "square.obj", SQUARE);
    let text = prints(&small(&square));
    assert!(text.starts_with("square: 2 triangles"), "{text}");

    let picture = path_text(&directory.path().join("square.png"));
    prints(&["render", &square, "-o", &picture, "--size", "20x10", "--view", "primitive"]);
    let decoded = Picture::read(Path::new(&picture)).unwrap();
    assert_eq!(decoded.size(), [20, 10]);
    let mut colours = decoded.pixels().to_vec();
    colours.sort_unstable();
    colours.dedup();
    assert_eq!(colours.len(), 3, "two triangles and nothing");
}

#[test]
fn an_empty_mesh_is_no_reason_to_fail() {
    let directory = tempfile::tempdir().unwrap();
    let flat = write(&directory, "flat.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n");
    let text = prints(&small(&flat));
    assert!(text.contains("1 triangle (1 degenerate)"), "{text}");
}

#[test]
fn compare_says_who_won_and_relates_to_what_is_asked_for() {
    let args = [&small("cube")[..], &["-s", "sah-kd", "-s", "sah-bvh"]].concat();
    // Lines end where they are full.
    let said = |args: &[&str]| stdout(&sahara(args)).split_whitespace().collect::<Vec<_>>().join(" ");
    let text = said(&args);
    assert!(text.contains("x sah-kd") && !text.contains("x median"), "{text}");
    assert!(text.contains(" is wrong in ") && text.ends_with(" checked rays."), "{text}");
    assert!(text.contains("times as many rays a second as sah-") || text.contains("cannot be told apart"), "{text}");
    let text = said(&[&args[..], &["--reference", "median-kd:leaf=8"]].concat());
    assert!(text.contains("x median-kd:leaf=8: speed against median-kd:leaf=8"), "{text}");
    // That sentence is about the reference, whoever has won.
    let last = text.rsplit("Over 1 scene and 2 kinds of rays, ").next().unwrap();
    assert!(last.contains("median-kd:leaf=8"), "{last}");
    let help = stdout(&sahara(&["--help"]));
    assert!(help.contains("Exit status") && help.contains("documented"), "{help}");
}

#[test]
fn tables_fit_80_columns_and_wide_ones_have_the_rest() {
    let four = ["compare", "cube", "--rays", "400", "--epochs", "2", "--budget", "1"];
    let directory = tempfile::tempdir().unwrap();
    let markdown = path_text(&directory.path().join("r.md"));
    let brief = stdout(&sahara(&[&four[..], &["--export-markdown", &markdown]].concat()));
    let wide = stdout(&sahara(&[&four[..], &["--wide"]].concat()));
    let columns = |text: &str| text.lines().find(|line| line.contains("structure")).unwrap().to_owned();
    let names =
        |text: &str| columns(text).split("  ").map(str::trim).filter(|n| !n.is_empty()).collect::<Vec<_>>().join(" ");
    assert_eq!(names(&brief), "structure primary shadow* diffuse random x obvhs");
    let rows = brief.lines().skip_while(|line| !line.contains("structure")).take(10);
    assert!(rows.clone().all(|row| row.chars().count() <= 80), "{brief}");
    for column in ["build", "peak", "memory", "tests", "steps", "checked", "sampled", "x median"] {
        let text = fs::read_to_string(&markdown).unwrap();
        assert!(columns(&wide).contains(column) && columns(&text).contains(column), "{column}");
        assert!(!columns(&brief).contains(column) && !brief.contains(&format!("{column}:")), "{brief}");
        assert!(column == "memory" || wide.contains(column) && text.contains(column), "{wide}");
    }
}

#[test]
fn a_quick_comparison_says_that_it_is_coarse() {
    let text = stdout(&sahara(&["compare", "cube", "-s", "sah-kd", "-s", "sah-bvh", "--quick"]));
    assert!(text.contains("Coarse: ") && text.trim_end().ends_with("checked rays."), "{text}");
    refuses(&["compare", "cube", "--quick", "--epochs", "9"], &["--quick", "--epochs"]);
}

#[test]
fn colour_is_as_asked() {
    let mut args = small("cube");
    args.extend(["--color", "always"]);
    assert!(stdout(&sahara(&args)).contains("\x1b["));
    args.pop();
    args.push("never");
    assert!(!stdout(&sahara(&args)).contains('\x1b'));
}

#[test]
fn a_reader_that_goes_away_is_no_error() {
    let mut child = command(&small("cube")).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    drop(child.stdout.take());
    let output = child.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(RIGHT), "{}", stderr(&output));
    assert!(stderr(&output).lines().all(is_line_of_log), "{}", stderr(&output));
}

#[test]
fn rays_that_no_scene_has_are_no_result() {
    let folder = tempfile::tempdir().unwrap();
    let json = path_text(&folder.path().join("none.json"));
    let sentence = ["nothing was measured: these scenes have no rays of the kinds asked for"];
    refuses_in_a_line(
        &["compare", "cube", "-w", "mirror", "--quick", "-s", "sah-kd", "--export-json", &json],
        &sentence,
    );
    assert!(!folder.path().join("none.json").exists());
    let threads = ["study", "threads", "cube", "-w", "mirror", "--most", "2", "--epochs", "1"];
    refuses_in_a_line(&[&threads[..], &["--dir", &path_text(folder.path())]].concat(), &sentence);
    // A scene that has them is enough.
    prints(&["compare", "cube", "billards", "-w", "mirror", "--quick", "-s", "sah-kd"]);
}

#[test]
fn a_kind_of_rays_that_is_named_twice_is_measured_once() {
    let text =
        prints(&["compare", "cube", "-w", "primary", "-w", "primary", "--quick", "-s", "sah-kd", "--export-json", "-"]);
    let records: serde_json::Value = serde_json::from_str(&text).unwrap();
    assert_eq!(records.as_array().unwrap().len(), 1, "{text}");
}
