//! `report` from outside: its folder, and rejected inputs.

use std::fs;
use std::path::Path;

use tempfile::TempDir;

use super::command::{at, prints, refuses_in_a_line, unwrapped, words};

fn text(path: &Path) -> &str {
    path.to_str().expect("the path is UTF-8")
}

/// A folder with a comparison of the torus.
fn runs() -> TempDir {
    let folder = TempDir::new().unwrap();
    let small = "compare torus -s median-kd -s sah-kd --rays 500 --runs 1 --epochs 1 --export-json";
    prints(&[words(small), vec![&at(&folder, "compare.json")]].concat());
    folder
}

#[test]
fn a_report_is_written_whole_with_pictures_and_again_in_its_place() {
    let (runs, place) = (runs(), TempDir::new().unwrap());
    let output = place.path().join("report");
    for _ in 0..2 {
        let said = prints(&["report", text(runs.path()), "-o", text(&output)]);
        let parts = ["Which structure is the fastest on Torus?", "index.html", "not measured"];
        assert_eq!(parts.map(|part| said.matches(part).count()), [1; 3], "{said}");
    }
    let page = fs::read_to_string(output.join("index.html")).unwrap();
    for part in words("data:image/png;base64, heat-torus speed-torus <svg viewBox type=\"range\" prefers-color-scheme")
    {
        assert!(page.contains(part), "{part}");
    }
    for file in ["report.md", "data/compare.csv", "figures/speed-torus.svg", "figures/scenes-1.png"] {
        assert!(output.join(file).is_file(), "{file}");
    }
    assert_eq!(fs::read_dir(place.path()).unwrap().count(), 1, "nothing is left beside it");

    // The same runs give the same page.
    let other = place.path().join("other");
    prints(&["report", text(runs.path()), "-o", text(&other)]);
    assert_eq!(fs::read_to_string(other.join("index.html")).unwrap(), page);

    // Heat has one scale on the page and in a picture: the costliest tree is on the page.
    let scale: u64 = page.split("--hottest ").nth(1).unwrap().split(' ').next().unwrap().parse().unwrap();
    let said = prints(&["render", "torus", "--view", "heat", "-o", &at(&place, "heat.png")]);
    let bar = format!("colour bar runs from 0 to {scale} ");
    assert!(said.contains("512 x 527 pixels") && said.contains(&bar), "{said}");
}

#[test]
fn what_cannot_be_reported_leaves_everything_as_it_was() {
    let (runs, place) = (runs(), TempDir::new().unwrap());
    let (run, output) = (text(runs.path()), place.path().join("notes"));
    fs::create_dir(&output).unwrap();
    fs::write(output.join("mine.txt"), "mine").unwrap();
    refuses_in_a_line(&["report", run, "-o", text(&output)], &["notes", "mine.txt", "another folder"]);
    refuses_in_a_line(&["report", run, "-o", text(&output.join("mine.txt"))], &["mine.txt", "file"]);
    assert_eq!(fs::read_to_string(output.join("mine.txt")).unwrap(), "mine");

    let new = place.path().join("new");
    let bytes = fs::read(runs.path().join("compare.json")).unwrap();
    fs::write(runs.path().join("torn.json"), &bytes[..bytes.len() / 2]).unwrap();
    refuses_in_a_line(&["report", run, "-o", text(&new)], &["torn.json", "cannot be parsed"]);
    assert_eq!(fs::read_dir(place.path()).unwrap().count(), 1);
}

#[test]
fn results_are_written_with_the_numbers_of_the_readme_beside_them() {
    let (runs, place) = (runs(), TempDir::new().unwrap());
    let (papers, readme) = (place.path().join("papers"), place.path().join("README.md"));
    let results = format!("--results={}", text(&papers));
    refuses_in_a_line(&["report", text(runs.path()), &results], &["no folder", "papers"]);

    fs::create_dir(&papers).unwrap();
    let marked = "# Mine\n\nIt is: <!-- sahara: compare.checked -->?<!-- / --> \
                  And: <!-- sahara: replicate.hard -->?<!-- / -->\n";
    fs::write(&readme, marked).unwrap();
    prints(&["report", text(runs.path()), &results]);
    let filled = fs::read_to_string(&readme).unwrap();
    for part in ["by another tree, brute force and exact arithmetic", "(`sahara study replicate --dir runs`)"] {
        assert!(unwrapped(&filled).contains(part), "{filled}");
    }
    let paper = fs::read_to_string(papers.join("RESULTS.md")).unwrap();
    assert!(paper.starts_with("# Results\n") && paper.contains("Not measured in this run: "), "{paper}");
    assert!(!paper.contains(text(runs.path())), "no path of this machine");
    assert!(papers.join("figures/speed-torus.svg").is_file() && papers.join("results.json").is_file());

    // Again it is the same; an unknown request leaves everything unchanged.
    prints(&["report", text(runs.path()), &results]);
    assert_eq!(fs::read_to_string(&readme).unwrap(), filled);
    fs::write(&readme, filled.replace("replicate.hard", "no.such")).unwrap();
    fs::remove_file(papers.join("RESULTS.md")).unwrap();
    refuses_in_a_line(&["report", text(runs.path()), &results], &["no.such", "compare.checked"]);
    assert!(!papers.join("RESULTS.md").exists());
}
