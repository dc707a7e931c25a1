//! Tests faulty mesh files, the memory of builds, and generated terrain.

use std::fs;

use serde_json::Value;

use super::command::{Folder, refused};
use super::journal::rows;
use crate::conformance::TREES;

#[test]
fn render_and_compare_print_what_was_left_out() {
    let folder = Folder::new();
    folder.write("a.obj", "mtllib no.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 1 2\n");
    for line in
        ["render a.obj -o a.png --size 8x8 --verbose", "compare a.obj --verbose -s median-kd -w primary --rays 16"]
    {
        folder.shows(line, &["1 face with fewer than three corners: ignored", "cannot read the materials in"]);
    }
}

#[test]
fn what_cannot_be_shown_is_refused_by_its_reason() {
    let folder = Folder::new();
    let scene = "name = \"S\"\n[camera]\neye = [0, 0, 5]\ntarget = [0, 0, 0]\nvertical_fov = 40\n\
                 [[objects]]\nmesh = \"cube\"\n[[objects]]\nmesh = \"points.obj\"\n";
    for (file, text, parts) in [
        (
            "far.obj",
            "v -3e38 0 0\nv 3e38 0 0\nv 0 3e38 0\nf 1 2 3\n",
            &["far", "its coordinates range from", "3e38"][..],
        ),
        ("points.obj", "v 0 0 0\nv 1 0 0\np 1 2\n", &["points.obj", "no triangles: no face has three corners"]),
        ("s.toml", scene, &["s.toml", "`objects[1].mesh`", "points.obj", "no triangles"]),
    ] {
        folder.write(file, text);
        folder.refuses_in_a_line(&format!("render {file} -o a.png"), parts);
        assert!(!fs::exists(folder.path("a.png")).unwrap());
    }
}

/// A folder with the scene file `ground.toml`.
fn terrain(triangles: &str) -> Folder {
    let folder = Folder::new();
    let text = format!(
        "name = \"Ground\"\n[camera]\neye = [0.0, 1.0, 2.0]\ntarget = [0.0, 0.0, 0.0]\nvertical_fov = 45.0\n\
         [[lights]]\npos = [3.0, 5.0, 4.0]\ncol = [1.0, 1.0, 1.0]\n\
         [[objects]]\nterrain = {{ triangles = {triangles} }}\n"
    );
    folder.write("ground.toml", text);
    folder
}

/// The limit of the peak memory of a build, in bytes per triangle, in addition to the mesh.
const BOUND: f64 = 200.0;

#[test]
fn builds_hold_less_than_200_bytes_a_triangle() {
    let triangles = 200_000;
    let folder = terrain(&triangles.to_string());
    let trees: String = TREES.iter().map(|name| format!(" -s {name}")).collect();
    let quick = "--quick --in-process -w primary --size 16x16";
    folder.prints(&format!("compare ground.toml {quick} --export-json r.json{trees}"));
    let records = rows(folder.path("r.json"));
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
    let right = terrain("1001");
    right.shows("validate ground.toml -s sah-bvh --rays 200", &["1,001 triangles"]);
    let render = "render ground.toml -o p.png --size 8x8";
    right.prints(render);
    for (wrong, parts) in [
        ("0", ["objects[0].terrain.triangles", "1 to 134217728"]),
        ("10, seed = -1", ["ground.toml, line 10", "u32"]),
        ("10 }\nmesh = \"cube\" # { 1", ["objects[0].terrain", "it excludes"]),
    ] {
        refused(&mut terrain(wrong).command(render), &parts);
    }
}
