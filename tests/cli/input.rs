//! Mesh files from users: messages for their faults and for omitted parts. Many triangles: memory of builds, and a
//! scene without a file.

use std::fs;

use serde_json::Value;

use super::command::{at, prints, refuses, refuses_in_a_line, words, write};
use super::journal::rows;
use crate::conformance::TREES;

#[test]
fn render_and_compare_print_what_was_left_out() {
    let folder = tempfile::tempdir().unwrap();
    let mesh = write(&folder, "a.obj", "mtllib no.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 1 2\n");
    for line in [
        format!("render {mesh} -o {} --size 8x8 --verbose", at(&folder, "a.png")),
        format!("compare {mesh} --verbose -s median-kd -w primary --rays 16"),
    ] {
        let printed = prints(&words(&line));
        assert!(printed.contains("1 face with fewer than three corners: ignored"), "{printed}");
        assert!(printed.contains("cannot read the materials in"), "{printed}");
    }
}

#[test]
fn what_cannot_be_shown_is_refused_by_its_reason() {
    let folder = tempfile::tempdir().unwrap();
    let picture = at(&folder, "a.png");
    let refused = |file: &str, parts: &[&str]| {
        refuses_in_a_line(&["render", file, "-o", &picture], parts);
        assert!(!fs::exists(&picture).unwrap());
    };
    let far = write(&folder, "far.obj", "v -3e38 0 0\nv 3e38 0 0\nv 0 3e38 0\nf 1 2 3\n");
    refused(&far, &["far", "its coordinates range from", "3e38"]);
    let points = write(&folder, "points.obj", "v 0 0 0\nv 1 0 0\np 1 2\n");
    refused(&points, &["points.obj", "no triangles: no face has three corners"]);
    let scene = "name = \"S\"\n[camera]\neye = [0, 0, 5]\ntarget = [0, 0, 0]\nvertical_fov = 40\n\
                 [[objects]]\nmesh = \"cube\"\n[[objects]]\nmesh = \"points.obj\"\n";
    refused(&write(&folder, "s.toml", scene), &["s.toml", "`objects[1].mesh`", "points.obj", "no triangles"]);
}

/// A scene file with a terrain of this many triangles.
fn terrain(triangles: &str) -> String {
    format!(
        "name = \"Ground\"\n[camera]\neye = [0.0, 1.0, 2.0]\ntarget = [0.0, 0.0, 0.0]\nvertical_fov = 45.0\n\
         [[lights]]\npos = [3.0, 5.0, 4.0]\ncol = [1.0, 1.0, 1.0]\n\
         [[objects]]\nterrain = {{ triangles = {triangles} }}\n"
    )
}

/// Maximum of bytes per triangle that a build of this crate may allocate beyond the mesh.
const BOUND: f64 = 200.0;

#[test]
fn builds_hold_less_than_200_bytes_a_triangle() {
    let triangles = 200_000;
    let folder = tempfile::tempdir().unwrap();
    let scene = write(&folder, "ground.toml", &terrain(&triangles.to_string()));
    let export = at(&folder, "r.json");
    let trees: String = TREES.iter().map(|name| format!(" -s {name}")).collect();
    let quick = "--quick --in-process -w primary --size 16x16";
    prints(&words(&format!("compare {scene} {quick} --export-json {export}{trees}")));
    let records = rows(&export);
    assert_eq!(records.len(), TREES.len());
    for record in &records {
        assert_eq!(record["triangles"], triangles);
        let per_triangle =
            |bytes: &Value| bytes.as_f64().expect("the command counts what it holds") / f64::from(triangles);
        let [peak, finished] = [&record["build_peak_bytes"], &record["shape"]["bytes"]].map(per_triangle);
        assert!(finished <= peak && peak < BOUND, "{}: {peak} bytes a triangle", record["structure"]);
    }
}

#[test]
fn a_terrain_needs_no_file_and_a_wrong_one_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let (file, picture) = (write(&folder, "ground.toml", &terrain("1001")), at(&folder, "p.png"));
    let told = prints(&["validate", &file, "-s", "sah-bvh", "--rays", "200"]);
    assert!(told.contains("1,001 triangles"), "{told}");
    prints(&["render", &file, "-o", &picture, "--size", "8x8"]);
    for (wrong, parts) in [
        ("0", ["objects[0].terrain.triangles", "1 to 134217728"]),
        ("10, seed = -1", ["ground.toml, line 10", "u32"]),
        ("10 }\nmesh = \"cube\" # { 1", ["objects[0].terrain", "it excludes"]),
    ] {
        write(&folder, "ground.toml", &terrain(wrong));
        refuses(&["render", &file, "-o", &picture], &parts);
    }
}
