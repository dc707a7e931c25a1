//! Mesh files as users give them: what is wrong is said, and so is what is left out.

use super::command::{prints, refuses_in_a_line, write};

#[test]
fn render_and_compare_print_what_was_left_out() {
    let folder = tempfile::tempdir().unwrap();
    let mesh = write(&folder, "a.obj", "mtllib no.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 1 2\n");
    let picture = folder.path().join("a.png");
    let rendered = prints(&["render", &mesh, "-o", picture.to_str().unwrap(), "--size", "8x8"]);
    let counted = prints(&["compare", &mesh, "-s", "median-kd", "-w", "primary", "--rays", "16"]);
    for printed in [rendered, counted] {
        assert!(printed.contains("1 face with fewer than three corners is left out"), "{printed}");
        assert!(printed.contains("no.mtl cannot be read"), "{printed}");
    }
}

#[test]
fn what_cannot_be_shown_is_refused_by_its_reason() {
    let folder = tempfile::tempdir().unwrap();
    let picture = folder.path().join("a.png");
    let refused = |file: &str, parts: &[&str]| {
        refuses_in_a_line(&["render", file, "-o", picture.to_str().unwrap()], parts);
        assert!(!picture.exists());
    };
    let far = write(&folder, "far.obj", "v -3e38 0 0\nv 3e38 0 0\nv 0 3e38 0\nf 1 2 3\n");
    refused(&far, &["far", "its coordinates reach from", "3e38"]);
    let points = write(&folder, "points.obj", "v 0 0 0\nv 1 0 0\np 1 2\n");
    refused(&points, &["points.obj", "no triangles: 2 vertices"]);
    let scene = "name = \"S\"\n[camera]\neye = [0, 0, 5]\ntarget = [0, 0, 0]\nvertical_fov = 40\n\
                 [[objects]]\nmesh = \"cube\"\n[[objects]]\nmesh = \"points.obj\"\n";
    refused(&write(&folder, "s.toml", scene), &["s.toml", "`objects[1].mesh`", "points.obj", "no triangles"]);
}
