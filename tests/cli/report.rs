//! Tests the folder that `report` writes, and the inputs that `report` rejects.

use std::fs;

use super::command::{Folder, assert_contains, unwrapped};

fn runs() -> Folder {
    let folder = Folder::new();
    fs::create_dir(folder.path("runs")).unwrap();
    let few = "--rays 500 --runs 1 --epochs 1 --export-json runs/compare.json";
    folder.prints(&format!("compare torus -s median-kd -s sah-kd {few}"));
    folder
}

#[test]
fn a_report_is_written_whole_with_pictures_and_again_in_its_place() {
    let folder = runs();
    for _ in 0..2 {
        let text = folder.prints("report runs -o report");
        let parts = ["Which structure is the fastest on Torus?", "index.html", "not measured"];
        assert_eq!(parts.map(|part| text.matches(part).count()), [1; 3], "{text}");
    }
    let page = folder.read("report/index.html");
    let graphics = ["data:image/png;base64,", "heat-torus", "speed-torus", "<svg", "viewBox", "type=\"range\""];
    assert_contains(&page, &[&graphics[..], &["prefers-color-scheme"]].concat());
    for file in ["report.md", "data/compare.csv", "figures/speed-torus.svg", "figures/scenes-1.png"] {
        assert!(folder.path("report").join(file).is_file(), "{file}");
    }
    assert_eq!(folder.names(), ["report", "runs"], "nothing is left beside it");

    folder.prints("report runs -o other");
    assert_eq!(folder.read("other/index.html"), page);

    // The page and `render` have the same heat scale.
    let scale: u64 = page.split("--hottest ").nth(1).unwrap().split(' ').next().unwrap().parse().unwrap();
    let bar = format!("colour bar runs from 0 to {scale} ");
    folder.shows("render torus --view heat -o heat.png", &["512 x 527 pixels", &bar]);
}

#[test]
fn what_cannot_be_reported_leaves_everything_as_it_was() {
    let folder = runs();
    fs::create_dir(folder.path("notes")).unwrap();
    folder.write("notes/mine.txt", "mine");
    folder.refuses_in_a_line("report runs -o notes", &["notes", "mine.txt", "another folder"]);
    folder.refuses_in_a_line("report runs -o notes/mine.txt", &["mine.txt", "file"]);
    assert_eq!(folder.read("notes/mine.txt"), "mine");

    let run = folder.read("runs/compare.json");
    folder.write("runs/torn.json", &run[..run.len() / 2]);
    folder.refuses_in_a_line("report runs -o new", &["torn.json", "cannot be parsed"]);
    assert_eq!(folder.names(), ["notes", "runs"]);
}

#[test]
fn results_are_written_with_the_numbers_of_the_readme_beside_them() {
    let folder = runs();
    let runs = folder.path("runs").to_str().unwrap().to_owned();
    let report = &format!("report {runs} --results=papers");
    folder.refuses_in_a_line(report, &["no folder", "papers"]);

    fs::create_dir(folder.path("papers")).unwrap();
    let marked = "# Mine\n\nIt is: <!-- sahara: compare.checked -->?<!-- / --> \
                  And: <!-- sahara: replicate.hard -->?<!-- / -->\n";
    folder.write("README.md", marked);
    folder.prints(report);
    let filled = folder.read("README.md");
    let findings = ["by another tree, brute force and exact arithmetic", "(`sahara study replicate --dir runs`)"];
    assert_contains(&unwrapped(&filled), &findings);
    let paper = folder.read("papers/RESULTS.md");
    assert!(paper.starts_with("# Results\n") && paper.contains("Not measured in this run: "), "{paper}");
    assert!(!paper.contains(&runs), "no path of this machine");
    for file in ["figures/speed-torus.svg", "results.json"] {
        assert!(folder.path("papers").join(file).is_file(), "{file}");
    }

    // A second run does not change the README. If the README refers to an unknown finding, no file is written.
    folder.prints(report);
    assert_eq!(folder.read("README.md"), filled);
    folder.write("README.md", filled.replace("replicate.hard", "no.such"));
    fs::remove_file(folder.path("papers/RESULTS.md")).unwrap();
    folder.refuses_in_a_line(report, &["no.such", "compare.checked"]);
    assert!(!folder.path("papers/RESULTS.md").exists());
}
