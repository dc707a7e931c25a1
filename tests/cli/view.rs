//! Tests `--camera`, `--inside` and `--size` in several commands.

use sahara::image;
use serde_json::Value;

use super::command::Folder;
use super::journal::rows;

/// A closed box that is longer than wide. The front sides of its triangles face inward.
fn room() -> Folder {
    let corner = |i: usize| format!("v {} {} {}\n", [-1, 1][i & 1], [0, 2][i >> 1 & 1], [-3, 3][i >> 2]);
    let corners: String = (0..8).map(corner).collect();
    let folder = Folder::new();
    folder.write("room.obj", corners + "f 1 2 4 3\nf 5 7 8 6\nf 1 5 6 2\nf 3 4 8 7\nf 1 3 7 5\nf 2 6 8 4\n");
    folder
}

#[test]
fn a_room_is_seen_from_outside_and_says_so_or_from_inside() {
    let folder = room();
    let compared = |view: &str| {
        let primary = "-s sah-kd -w primary --epochs 1 --budget 1 --size 20x10 --verbose --export-json r.json";
        let text = folder.prints(&format!("compare room.obj {primary} {view}"));
        let row = &rows(folder.path("r.json"))[0];
        let number = |value: &Value| value.as_u64().unwrap();
        (text.contains("from outside"), number(&row["all"]), number(&row["counts"]["hits"]))
    };
    let (says, rays, hits) = compared("");
    assert!(says && rays == 200 && hits < 200, "{hits}");
    assert_eq!(compared("--inside"), (false, 200, 200));
    assert_eq!(compared("--camera '0,1,0 0,1,3 60'"), (false, 200, 200));
    assert_eq!(compared("--camera '0,1,9 0,1,20'"), (false, 200, 0), "it looks away");
}

#[test]
fn validate_and_render_look_from_there_as_well() {
    let folder = room();
    for (view, is_outside) in [("", true), ("--inside", false)] {
        let text = folder.prints(&format!("validate room.obj -s sah-kd --size 20x10 {view} --rays 600 --verbose"));
        assert_eq!(text.contains("from outside"), is_outside, "{text}");
    }
    let size = || image::image_dimensions(folder.path("p.png")).unwrap();
    folder.prints("render room.obj -s sah-kd --size 20x10 --inside -o p.png --view primitive");
    assert_eq!(size(), (20, 10));
    folder.shows("render cube -o p.png --size 24x24 --view error -s sah-kd:test=exact", &["missed 0 (vermilion)"]);
    assert_eq!(size(), (24, 24));

    let both = "compare room.obj --inside --camera '0,1,0 0,1,3'";
    folder.refuses(both, &["--inside", "--camera"]);
    folder.refuses_in_a_line("compare room.obj --camera '0,1,0 0,1,0'", &["--camera", "same point"]);
    folder.write("point.obj", "v 1 2 3\nv 1 2 3\nv 1 2 3\nf 1 2 3\n");
    folder.refuses_in_a_line("compare point.obj --inside", &["--inside", "same point"]);
}
