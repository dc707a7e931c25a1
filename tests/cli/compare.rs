//! Tests the files, tables and messages of `sahara compare`.

use std::collections::HashSet;

use sahara::image;
use sahara::registry::Registry;
use sahara::request::{is_obvhs, known_defect};

use super::command::{Folder, NOT_BUILT, RIGHT, SQUARE, assert_contains, command, ends, json, unwrapped};
use super::journal::rows;

const SMALL: &str = "--rays 400 --runs 2 --budget 1 -w primary -w shadow";

/// The structures of a default comparison, without the structures of optional features.
const FIELD: &str = "brute-force median-kd sah-kd sah-kd-wide sah-kd-tight sah-hybrid sah-hybrid:batch=packets \
                     sah-bvh obvhs-bvh2 obvhs-cwbvh";

fn with_field(command: &str) -> String {
    FIELD.split_whitespace().fold(command.into(), |command, structure| format!("{command} -s {structure}"))
}

#[test]
fn results_go_to_files_that_read_back() {
    let folder = Folder::new();
    let files = "--export-json r.json --export-csv r.csv --export-markdown r.md";
    let is_absent = Registry::builtin().all().iter().any(|choice| choice.entry.absence().is_some());
    let status = if is_absent { NOT_BUILT } else { RIGHT };
    let [printed, messages] = folder.ends(status, &format!("compare Cube {SMALL} {files}"));
    // Messages may contain warnings and the progress of a long run.
    let is_line_of_log = |line: &str| line.starts_with("warning: ") || line.contains(" %: ");
    assert!(messages.lines().all(is_line_of_log), "no progress bar without a terminal: {messages}");

    let mut rows = rows(folder.path("r.json"));
    let measured = rows.len();
    let is_peer = |label: &str| known_defect(label).is_some() && !is_obvhs(label);
    rows.retain(|row| !is_peer(row["label"].as_str().unwrap()));
    let field: Vec<&str> = FIELD.split_whitespace().collect();
    assert_eq!(rows.len(), field.len() * 2);
    for (i, row) in rows.iter().enumerate() {
        assert_eq!((&row["scene"], &row["triangles"]), (&"Cube".into(), &12.into()));
        assert_eq!(row["label"], field[i / 2]);
        assert_eq!(row["query"], ["closest", "any"][i % 2]);
        assert_eq!(row["checked"]["errors"], 0, "{row}");
        assert!(row["ns"][0].as_u64().unwrap() > 0 && row["build_ns"].as_u64().unwrap() > 0, "{row}");
    }
    let provenance = &json(folder.path("r.json"))["provenance"];
    assert!(provenance["command"].as_str().unwrap().contains("--export-json"), "{provenance}");

    let mut reader = csv::Reader::from_path(folder.path("r.csv")).unwrap();
    let names = reader.headers().unwrap().clone();
    for name in ["scene", "structure", "label", "workload", "mrays_per_s", "pays_off_after_rays"] {
        assert!(names.iter().any(|own| own == name), "{names:?}");
    }
    assert_eq!(reader.records().map(Result::unwrap).count(), measured);

    let text = folder.read("r.md");
    for structure in field {
        let short = structure.split(':').next_back().unwrap();
        assert!(text.contains(&format!("| {structure} |")) && printed.contains(short), "{text}\n{printed}");
    }
    assert!(!printed.contains('\x1b'), "no colour without a terminal");
    assert_eq!(folder.names(), ["r.csv", "r.json", "r.md"], "nothing else is left behind");
}

#[test]
fn a_file_without_camera_is_compared_and_rendered() {
    let folder = Folder::new();
    folder.write("square.obj", SQUARE);
    // `compare` accepts a mesh with only degenerate triangles.
    folder.write("flat.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n");
    for (mesh, title) in [("square", "square: 2 triangles"), ("flat", "flat: 1 triangle (1 degenerate)")] {
        let text = folder.prints(&with_field(&format!("compare {mesh}.obj {SMALL}")));
        assert!(text.starts_with(title), "{text}");
    }
    folder.prints("render square.obj -o square.png --size 20x10 --view primitive");
    let decoded = image::open(folder.path("square.png")).unwrap().into_rgb8();
    assert_eq!(decoded.dimensions(), (20, 10));
    let colours: HashSet<_> = decoded.pixels().collect();
    assert_eq!(colours.len(), 3, "two triangles and the background");
}

#[test]
fn compare_says_who_won_and_relates_to_what_is_asked_for() {
    let run =
        |more: &str| unwrapped(&Folder::new().prints(&format!("compare cube {SMALL} -s sah-kd -s sah-bvh {more}")));
    let text = run("");
    assert_contains(&text, &["x sah-kd", "Wrong hits: 0 in ", "has the highest mean speed over 2 common cells"]);
    assert!(!text.contains("x median"), "{text}");
    let text = run("--reference median-kd:leaf=8 --verbose");
    assert!(text.contains("x median-kd:leaf=8: speed against median-kd:leaf=8"), "{text}");
    let last = text.rsplit("structures with exact or f64 triangle tests").next().unwrap();
    assert!(last.contains("median-kd:leaf=8"), "that sentence is about the reference: {last}");
}

#[test]
fn tables_stand_alone_and_notes_are_counted_unless_all_is_asked_for() {
    let run = "compare cube starters -s sah-kd -s sah-hybrid -s sah-hybrid:batch=packets -w primary --rays 256 \
               --epochs 2 --budget 1";
    let brief = Folder::new().prints(run);
    let mut blocks: Vec<Vec<&str>> = brief.trim_end().split("\n\n").map(|block| block.lines().collect()).collect();
    let foot = blocks.pop().unwrap();
    // Each table has a title, a header, and a row for each of three structures.
    assert!(blocks.len() == 3 && blocks.iter().all(|table| table.len() == 2 + 3), "{brief}");
    let (count, foot) = foot.split_last().unwrap();
    // The length of the last sentence, which names the machine and the program, depends on both.
    let sentences = foot.iter().take_while(|line| !line.contains(" thread ")).count();
    assert!(sentences <= 4 && count.ends_with(" notes: --verbose shows them"), "{brief}");
    let notes: usize = count.split(' ').next().unwrap().parse().unwrap();

    let verbose = Folder::new().prints(&format!("{run} --verbose"));
    let least = brief.lines().count() + notes - 1;
    assert!(!verbose.contains("--verbose") && verbose.lines().count() >= least, "{verbose}");
    for note in ["stands in for", "textures ignored", "A/A noise", "Workload columns", "the row above"] {
        assert!(verbose.contains(note) && !brief.contains(note), "{note}: {verbose}");
    }
}

#[test]
fn tables_fit_80_columns_and_wide_ones_have_the_rest() {
    let folder = Folder::new();
    let run = |more: &str| folder.prints(&with_field(&format!("compare cube --rays 400 --epochs 2 --budget 1 {more}")));
    let (brief, wide) = (run("--export-markdown r.md"), run("--wide"));
    let markdown = folder.read("r.md");
    let header = brief.lines().find(|line| line.contains("structure")).unwrap();
    let names: Vec<&str> = header.split("  ").map(str::trim).filter(|name| !name.is_empty()).collect();
    assert_eq!(names.join(" "), "structure primary shadow* diffuse random x obvhs");
    let mut rows = brief.lines().skip_while(|line| *line != header).take(10);
    assert!(rows.all(|row| row.chars().count() <= 80), "{brief}");
    for column in ["build", "memory", "nodes", "refs/triangle", "SAH cost", "tests", "checked", "pays off", "x median"]
    {
        assert!(wide.contains(column) && markdown.contains(column), "{column}: {wide}");
        assert!(!header.contains(column) && !brief.contains(&format!("{column}:")), "{brief}");
    }
}

#[test]
fn a_quick_comparison_says_that_it_is_coarse_in_colour_as_asked() {
    for (colour, is_there) in [("always", true), ("never", false)] {
        let text =
            Folder::new().prints(&format!("compare cube -s sah-kd -s sah-bvh --quick --verbose --color {colour}"));
        assert_contains(&unwrapped(&text), &["Coarse: ", "Wrong hits: 0 in "]);
        assert_eq!(text.contains("\x1b["), is_there, "{text}");
    }
    Folder::new().refuses("compare cube --quick --epochs 9", &["--quick", "--epochs"]);
}

#[test]
fn rays_that_no_scene_has_are_no_result() {
    let folder = Folder::new();
    let nothing = "nothing was measured: these scenes have no rays of these workloads";
    folder.refuses_in_a_line("compare cube -w mirror --quick -s sah-kd --export-json none.json", &[nothing]);
    assert!(folder.names().is_empty());
    // The command succeeds if at least one scene has mirrors.
    Folder::new().prints("compare cube billards -w mirror --quick -s sah-kd");
}

#[test]
fn a_build_that_takes_too_long_is_refused_and_the_others_are_measured() {
    let small = "compare icosphere:6 -w primary --rays 256 --epochs 2 --size 16x16";
    let [text, _] = ends(NOT_BUILT, &mut command(&format!("{small} -s sah-kd -s brute-force --build-limit 0.001")));
    assert_contains(&text, &["Refused: ", "--build-limit"]);
}
