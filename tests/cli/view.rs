//! `--camera`, `--inside` and `--size` mean the same in all commands with a camera.

use sahara::image;
use serde_json::Value;
use tempfile::TempDir;

use super::command::{at, prints, refuses, refuses_in_a_line, words, write};

/// A closed box that is longer than it is wide, with its fronts inside.
fn room(folder: &TempDir) -> String {
    let corner = |i: usize| format!("v {} {} {}\n", [-1, 1][i & 1], [0, 2][i >> 1 & 1], [-3, 3][i >> 2]);
    let corners: String = (0..8).map(corner).collect();
    let walls = "f 1 2 4 3\nf 5 7 8 6\nf 1 5 6 2\nf 3 4 8 7\nf 1 3 7 5\nf 2 6 8 4\n";
    write(folder, "room.obj", &(corners + walls))
}

#[test]
fn a_room_is_seen_from_outside_and_says_so_or_from_inside() {
    let folder = TempDir::new().unwrap();
    let (room, json) = (room(&folder), at(&folder, "r.json"));
    let compared = |view: &[&str]| {
        let primary = "-s sah-kd -w primary --epochs 1 --budget 1 --size 20x10 --verbose";
        let line = format!("compare {room} {primary} --export-json {json}");
        let text = prints(&[&words(&line)[..], view].concat());
        let row = &super::journal::rows(&json)[0];
        let number = |value: &Value| value.as_u64().unwrap();
        (text.contains("from outside"), number(&row["all"]), number(&row["counts"]["hits"]))
    };
    let (says, rays, hits) = compared(&[]);
    assert!(says && rays == 200 && hits < 200, "{hits}");
    // Every ray meets a wall.
    assert_eq!(compared(&["--inside"]), (false, 200, 200));
    assert_eq!(compared(&["--camera", "0,1,0 0,1,3 60"]), (false, 200, 200));
    let (says, _, hits) = compared(&["--camera", "0,1,9 0,1,20"]);
    assert!(!says && hits == 0, "it looks away");
}

#[test]
fn validate_and_render_look_from_there_as_well() {
    let folder = TempDir::new().unwrap();
    let (room, picture) = (room(&folder), at(&folder, "p.png"));
    let [outside, inside] = ["", " --inside"].map(|inside| format!("{room} -s sah-kd --size 20x10{inside}"));
    for (view, is_outside) in [(&outside, true), (&inside, false)] {
        let text = prints(&words(&format!("validate {view} --rays 600 --verbose")));
        assert_eq!(text.contains("from outside"), is_outside, "{text}");
    }
    prints(&words(&format!("render {inside} -o {picture} --view primitive")));
    assert_eq!(image::image_dimensions(&picture).unwrap(), (20, 10));
    let text = prints(&words(&format!("render cube -o {picture} --size 24x24 --view error -s sah-kd:test=exact")));
    assert!(text.contains("missed 0 (vermilion)"), "what its colours mean: {text}");
    assert_eq!(image::image_dimensions(&picture).unwrap(), (24, 24));

    refuses(&["compare", &room, "--inside", "--camera", "0,1,0 0,1,3"], &["--inside", "--camera"]);
    refuses_in_a_line(&["compare", &room, "--camera", "0,1,0 0,1,0"], &["--camera", "same point"]);
    let point = write(&folder, "point.obj", "v 1 2 3\nv 1 2 3\nv 1 2 3\nf 1 2 3\n");
    refuses_in_a_line(&["compare", &point, "--inside"], &["--inside", "same point"]);
}
