//! `sahara compare`: files, winners, colours, odd meshes.

use std::collections::HashSet;
use std::fs;
use std::path::PathBuf;

use sahara::image;

use super::command::{
    NOT_BUILT, RIGHT, SQUARE, at, command, ends, json, prints, refuses, refuses_in_a_line, sahara, small, stdout,
    unwrapped, write,
};
use super::journal::rows;

#[test]
fn results_go_to_files_that_read_back() {
    let directory = tempfile::tempdir().unwrap();
    let [export, csv, markdown] = ["r.json", "r.csv", "r.md"].map(|name| at(&directory, name));
    let mut args = small("Cube");
    args.extend(["--export-json", &export, "--export-csv", &csv, "--export-markdown", &markdown]);
    let (printed, told) = ends(RIGHT, &mut command(&args));
    // A warning, or the progress of a long run.
    let is_line_of_log = |line: &str| line.starts_with("warning: ") || line.contains(" %: ");
    assert!(told.lines().all(is_line_of_log), "no bar where nobody looks: {told}");

    let rows = rows(&export);
    let ours = ["brute-force", "median-kd", "sah-kd", "sah-kd-wide", "sah-kd-tight", "sah-hybrid"];
    let structures = [&ours[..], &["sah-hybrid:batch=packets", "sah-bvh", "obvhs-bvh2", "obvhs-cwbvh"]].concat();
    assert_eq!(rows.len(), structures.len() * 2);
    for (i, row) in rows.iter().enumerate() {
        assert_eq!((&row["scene"], &row["triangles"]), (&"Cube".into(), &12.into()));
        assert_eq!(row["label"], structures[i / 2]);
        assert_eq!(row["query"], ["closest", "any"][i % 2]);
        assert_eq!(row["checked"]["errors"], 0, "{row}");
        assert!(row["ns"][0].as_u64().unwrap() > 0 && row["build_ns"].as_u64().unwrap() > 0, "{row}");
    }
    let provenance = &json(&export)["provenance"];
    assert!(provenance["command"].as_str().unwrap().contains("--export-json"), "{provenance}");

    let mut reader = csv::Reader::from_path(&csv).unwrap();
    let names = reader.headers().unwrap().clone();
    for name in ["scene", "structure", "label", "workload", "mrays_per_s", "pays_off_after_rays"] {
        assert!(names.iter().any(|own| own == name), "{names:?}");
    }
    assert_eq!(reader.records().map(Result::unwrap).count(), rows.len());

    let text = fs::read_to_string(&markdown).unwrap();
    for structure in structures {
        let short = structure.split(':').next_back().unwrap();
        assert!(text.contains(&format!("| {structure} |")) && printed.contains(short), "{text}\n{printed}");
    }
    assert!(!printed.contains('\x1b'), "no colour where nobody looks");
    let mut left: Vec<PathBuf> = fs::read_dir(directory.path()).unwrap().map(|entry| entry.unwrap().path()).collect();
    left.sort();
    assert_eq!(left, [&csv, &export, &markdown].map(PathBuf::from), "nothing else is left behind");
}

#[test]
fn a_file_without_camera_is_compared_and_rendered() {
    let directory = tempfile::tempdir().unwrap();
    let square = write(&directory, "square.obj", SQUARE);
    let text = prints(&small(&square));
    assert!(text.starts_with("square: 2 triangles"), "{text}");
    // An empty mesh is no reason to fail.
    let flat = write(&directory, "flat.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n");
    let text = prints(&small(&flat));
    assert!(text.contains("1 triangle (1 degenerate)"), "{text}");

    let picture = at(&directory, "square.png");
    prints(&["render", &square, "-o", &picture, "--size", "20x10", "--view", "primitive"]);
    let decoded = image::open(&picture).unwrap().into_rgb8();
    assert_eq!(decoded.dimensions(), (20, 10));
    let colours: HashSet<_> = decoded.pixels().collect();
    assert_eq!(colours.len(), 3, "two triangles and nothing");
}

#[test]
fn compare_says_who_won_and_relates_to_what_is_asked_for() {
    let args = [&small("cube")[..], &["-s", "sah-kd", "-s", "sah-bvh"]].concat();
    let said = |args: &[&str]| unwrapped(&stdout(&sahara(args)));
    let text = said(&args);
    assert!(text.contains("x sah-kd") && !text.contains("x median"), "{text}");
    assert!(
        text.contains("Wrong hits: 0 in ") && text.contains("has the highest mean speed over 2 common cells"),
        "{text}"
    );
    let text = said(&[&args[..], &["--reference", "median-kd:leaf=8", "--verbose"]].concat());
    assert!(text.contains("x median-kd:leaf=8: speed against median-kd:leaf=8"), "{text}");
    let last = text.rsplit("structures with exact or f64 triangle tests").next().unwrap();
    assert!(last.contains("median-kd:leaf=8"), "that sentence is about the reference: {last}");
}

#[test]
fn tables_stand_alone_and_notes_are_counted_unless_all_is_asked_for() {
    let run = ["compare", "cube", "starters", "-s", "sah-kd", "-s", "sah-hybrid", "-s", "sah-hybrid:batch=packets"];
    let run = [&run[..], &["-w", "primary", "--rays", "256", "--epochs", "2", "--budget", "1"]].concat();
    let brief = prints(&run);
    let mut blocks: Vec<Vec<&str>> = brief.trim_end().split("\n\n").map(|block| block.lines().collect()).collect();
    let foot = blocks.pop().unwrap();
    // The title, the header and a row for each structure.
    assert!(blocks.len() == 3 && blocks.iter().all(|table| table.len() == 2 + 3), "{brief}");
    let (count, foot) = foot.split_last().unwrap();
    assert!(foot.len() <= 5 && count.ends_with(" notes: --verbose shows them"), "{brief}");
    let number: usize = count.split(' ').next().unwrap().parse().unwrap();

    let verbose = prints(&[&run[..], &["--verbose"]].concat());
    assert!(
        !verbose.contains("--verbose") && verbose.lines().count() >= brief.lines().count() + number - 1,
        "{verbose}"
    );
    for note in ["stands in for", "textures ignored", "A/A noise", "Workload columns", "the row above"] {
        assert!(verbose.contains(note) && !brief.contains(note), "{note}: {verbose}");
    }
}

#[test]
fn tables_fit_80_columns_and_wide_ones_have_the_rest() {
    let four = ["compare", "cube", "--rays", "400", "--epochs", "2", "--budget", "1"];
    let directory = tempfile::tempdir().unwrap();
    let markdown = at(&directory, "r.md");
    let brief = stdout(&sahara(&[&four[..], &["--export-markdown", &markdown]].concat()));
    let wide = stdout(&sahara(&[&four[..], &["--wide"]].concat()));
    let columns = |text: &str| text.lines().find(|line| line.contains("structure")).unwrap().to_owned();
    let names =
        |text: &str| columns(text).split("  ").map(str::trim).filter(|n| !n.is_empty()).collect::<Vec<_>>().join(" ");
    assert_eq!(names(&brief), "structure primary shadow* diffuse random x obvhs");
    let rows = brief.lines().skip_while(|line| !line.contains("structure")).take(10);
    assert!(rows.clone().all(|row| row.chars().count() <= 80), "{brief}");
    for column in ["build", "memory", "nodes", "refs/triangle", "SAH cost", "tests", "checked", "pays off", "x median"]
    {
        let text = fs::read_to_string(&markdown).unwrap();
        assert!(wide.contains(column) && text.contains(column), "{column}: {wide}");
        assert!(!columns(&brief).contains(column) && !brief.contains(&format!("{column}:")), "{brief}");
    }
}

#[test]
fn a_quick_comparison_says_that_it_is_coarse_in_colour_as_asked() {
    for (colour, is_there) in [("always", true), ("never", false)] {
        let quick = ["compare", "cube", "-s", "sah-kd", "-s", "sah-bvh", "--quick", "--verbose", "--color", colour];
        let text = unwrapped(&stdout(&sahara(&quick)));
        assert!(text.contains("Coarse: ") && text.contains("Wrong hits: 0 in "), "{text}");
        assert_eq!(text.contains("\x1b["), is_there, "{text}");
    }
    refuses(&["compare", "cube", "--quick", "--epochs", "9"], &["--quick", "--epochs"]);
}

#[test]
fn rays_that_no_scene_has_are_no_result() {
    let folder = tempfile::tempdir().unwrap();
    let json = at(&folder, "none.json");
    let mirror = ["compare", "cube", "-w", "mirror", "--quick", "-s", "sah-kd", "--export-json", &json];
    refuses_in_a_line(&mirror, &["nothing was measured: these scenes have no rays of these workloads"]);
    assert!(!folder.path().join("none.json").exists());
    // One scene with mirrors is enough.
    prints(&["compare", "cube", "billards", "-w", "mirror", "--quick", "-s", "sah-kd"]);
}

#[test]
fn a_build_that_takes_too_long_is_refused_and_the_others_are_measured() {
    let small = ["compare", "icosphere:6", "-w", "primary", "--rays", "256", "--epochs", "2", "--size", "16x16"];
    let args = [&small[..], &["-s", "sah-kd", "-s", "brute-force", "--build-limit", "0.001"]].concat();
    let (said, _) = ends(NOT_BUILT, &mut command(&args));
    assert!(said.contains("Refused: ") && said.contains("--build-limit"), "{said}");
}
