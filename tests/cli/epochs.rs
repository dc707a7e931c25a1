//! `counts` and the studies of curves from outside: what they print, keep and refuse.

use tempfile::TempDir;

use super::command::{json, prints, refuses, refuses_in_a_line};
use super::journal::cases;

#[test]
fn counts_are_printed_and_exported() {
    let folder = TempDir::new().unwrap();
    let file = folder.path().join("counts.json");
    let small = ["study", "counts", "cube", "-s", "median-kd", "-s", "sah-bvh", "-w", "primary", "--rays", "400"];
    let text = prints(&[&small[..], &["--export-json", file.to_str().unwrap()]].concat());
    for part in ["EPO", "Cube, primary rays (closest)", "x minimum", "leaves by size and by depth"] {
        assert!(text.contains(part), "{part:?} is not in {text}");
    }
    // Of all that is counted branch misses alone are not the same again, to the bit.
    let counted = || {
        let mut measures = json(&file)["result"].take();
        for rays in measures.as_array_mut().unwrap().iter_mut().flat_map(|one| one["rays"].as_array_mut().unwrap()) {
            rays["branch_misses_per_ray"].take();
        }
        measures
    };
    let measures = counted();
    assert_eq!(measures[0]["structure"], "median-kd");
    assert_eq!(measures[0]["tree"]["leaf_sizes"], serde_json::json!([[12, 1]]));
    assert_eq!(measures[0]["tree"]["end_point_overlap"], 0.0);
    prints(&[&small[..], &["--export-json", file.to_str().unwrap()]].concat());
    assert_eq!(counted(), measures);
    let long = prints(&[&small[..], &["--histograms"]].concat());
    assert!(long.contains("Cube, median-kd: leaves by size"), "{long}");
}

/// A study that takes no time, in a folder.
fn small<'a>(study: &'a [&'a str], folder: &'a str) -> Vec<&'a str> {
    let sizes = ["-w", "primary", "--rays", "64", "--runs", "1", "--budget", "1", "--dir", folder];
    [&["study"], study, &sizes[..]].concat()
}

const STUDIES: [&[&str]; 3] = [
    &["scaling", "cube", "--finest", "2", "-s", "median-kd", "-s", "sah-bvh"],
    &["break-even", "cube", "torus", "-s", "median-kd", "-s", "sah-bvh"],
    &["costs", "cube", "torus", "-s", "median-kd", "-s", "sah-kd", "-s", "sah-bvh"],
];

#[test]
fn a_study_goes_on_where_it_stopped_and_repeats_what_it_said() {
    for study in STUDIES {
        let folder = TempDir::new().unwrap();
        let dir = folder.path().to_str().unwrap();
        let cases = || cases(folder.path(), study[0]);
        let one = [&small(study, dir)[..], &["--epochs", "1"]].concat();
        let first = prints(&one);
        let measured = cases().len();
        assert!(measured > 0, "{study:?}");
        assert_eq!(prints(&one), first, "{study:?} measures nothing again");
        assert_eq!(cases().len(), measured);

        // A second epoch measures as many cases once more, and changes the answer.
        prints(&[&small(study, dir)[..], &["--epochs", "2"]].concat());
        assert_eq!(cases().len(), 2 * measured, "{study:?}");
        // A case that is removed is measured again.
        std::fs::remove_file(&cases()[0]).unwrap();
        prints(&[&small(study, dir)[..], &["--epochs", "2"]].concat());
        assert_eq!(cases().len(), 2 * measured, "{study:?}");

        refuses_in_a_line(&[&one[..], &["--seed", "2"]].concat(), &["seed was 1 and is 2", "--fresh"]);
    }
}

#[test]
fn the_crossover_races_the_pairs_that_are_there() {
    let folder = TempDir::new().unwrap();
    let pair =
        ["crossover", "--deepest", "1", "-s", "sah-kd-wide:test=moller-trumbore", "-s", "sah-bvh:test=moller-trumbore"];
    let file = folder.path().join("races.json");
    let exports = ["--epochs", "1", "--export-json", file.to_str().unwrap()];
    let text = prints(&[&small(&pair, folder.path().to_str().unwrap())[..], &exports].concat());
    assert!(text.contains("sah-kd-wide / sah-bvh, primary"), "{text}");
    let races = &json(&file)["result"];
    assert_eq!((races.as_array().unwrap().len(), &races[0]["members"][0]["layers"]), (1, &serde_json::json!(1)));
}

#[test]
fn what_is_wrong_is_said_before_anything_is_measured() {
    let folder = TempDir::new().unwrap();
    let dir = folder.path().to_str().unwrap();
    refuses(&["study", "scaling", "no-such-scene", "--dir", dir], &["no-such-scene"]);
    refuses(&["study", "scaling", "--finest", "11", "--dir", dir], &["11", "10"]);
    refuses(&["study", "crossover", "--deepest", "0", "--dir", dir], &["0"]);
    refuses(&["study", "break-even", "cube", "-s", "sah-kd:leef=3", "--dir", dir], &["leef"]);
    refuses(&["study", "costs", "cube", "--epochs", "0", "--dir", dir], &["0"]);
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0, "nothing was begun");
}
