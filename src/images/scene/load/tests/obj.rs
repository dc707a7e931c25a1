use glam::Vec3;

use super::{assert_refused, load_files};
use crate::scene::{Material, Model};

fn obj(text: &str) -> Model {
    load_files(&[("a.obj", text.as_bytes())]).unwrap()
}

fn with_library(text: &str, library: &[u8]) -> Model {
    let text = format!("mtllib a.mtl # colours\n{text}");
    load_files(&[("a.obj", text.as_bytes()), ("a.mtl", library)]).unwrap()
}

fn colours(model: &Model) -> Vec<Vec3> {
    model.materials.iter().map(|material| material.diffuse).collect()
}

const SQUARE: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 9 9 9\n";

#[test]
fn polygons_are_fans_and_vertices_keep_their_order() {
    let model = obj(&format!("{SQUARE}g a\nf 1 2 3 4\ng b\nl 1 2\np 3\nf 4 3 2\nf 1 2\n"));
    assert_eq!(model.triangles, [[0, 1, 2], [0, 2, 3], [3, 2, 1]]);
    // The model omits the unused vertex.
    assert_eq!(model.positions, [Vec3::ZERO, Vec3::X, Vec3::new(1.0, 1.0, 0.0), Vec3::Y]);
    assert!(model.normals.is_empty() && model.normal_indices.is_empty() && model.material_of.is_empty());
    assert_eq!(model.materials, [Material::named("default")]);
    let left_out =
        ["1 face with fewer than three corners: ignored", "2 statements of points, lines, curves or surfaces: ignored"];
    assert_eq!(model.notes, left_out);
}

#[test]
fn indices_may_be_negative_forward_and_continued() {
    assert_eq!(obj(&format!("{SQUARE}f -5 -4 -3\n")).triangles, [[0, 1, 2]]);
    assert_eq!(obj(&format!("f 1 2 3 # first\r\n{SQUARE}")).triangles, [[0, 1, 2]]);
    assert_eq!(obj(&format!("{SQUARE}f 1 2 \\\n3 4 \\")).triangles, [[0, 1, 2], [0, 2, 3]]);
    // A negative index counts back from the last vertex before the face.
    assert_eq!(obj("v 0 0 0\nv 1 0 0\nv 1 1 0\nf -3 -2 -1\nv 5 5 5\n").triangles, [[0, 1, 2]]);
}

#[test]
fn corners_have_normals_or_the_face_is_flat() {
    let model = obj(&format!("{SQUARE}vt 0 0\nvn 0 0 1\nvn 0 1 0\nf 1//1 2//2 3//-1\nf 1/1/1 2/1/1 3/1\nf 1 2 3\n"));
    assert_eq!(model.normal_indices, [[0, 1, 1], [Model::FLAT; 3], [Model::FLAT; 3]]);
    assert_eq!(model.normals, [Vec3::Z, Vec3::Y]);
    let model =
        obj(&format!("{SQUARE}vn 0 0 0\nvn nan 0 1\nvn 0 0 2\nf 1//1 2//3 3//3\nf 1//2 2//3 3//3\nf 1//3 2//3 3//3\n"));
    assert_eq!(model.normal_indices, [[Model::FLAT; 3], [Model::FLAT; 3], [2; 3]]);
    assert!(model.notes[0].starts_with("2 triangles"), "{:?}", model.notes);
}

#[test]
fn materials_come_from_the_mtl_file() {
    let text = format!(
        "mtllib my colours.mtl\n{SQUARE}f 1 2 3\nusemtl red wall\nf 1 2 3 4\nusemtl grey\nf 1 2 3\nusemtl lost\nf 1 2 3\n"
    );
    let mtl = "# by hand\nnewmtl unused\nKd 1 1 1\nnewmtl red wall\n  Ka 0.1 0 0\n\tKd 1.5 0.25 -1\nKs 0.5 0.5 0.5\nNs 64\nmap_Kd a.png\nillum\nnewmtl grey\nKd 0.5\nKs spectral x.rfl\nNs\n";
    let model = load_files(&[("a.obj", text.as_bytes()), ("my colours.mtl", mtl.as_bytes())]).unwrap();
    assert_eq!(model.material_of, [0, 1, 1, 2, 3]);
    let names: Vec<_> = model.materials.iter().map(|m| m.name.as_str()).collect();
    assert_eq!(names, ["default", "red wall", "grey", "lost"]);
    let red = &model.materials[1];
    assert_eq!((red.ambient, red.diffuse), (Vec3::new(0.1, 0.0, 0.0), Vec3::new(1.0, 0.25, 0.0)));
    assert_eq!((red.specular, red.shininess, red.mirror), (Vec3::splat(0.5), 64.0, 0.0));
    assert_eq!(model.materials[2], Material { diffuse: Vec3::splat(0.5), ..Material::named("grey") });
    assert_eq!(model.notes.len(), 4, "{:?}", model.notes);
    for (note, words) in model.notes.iter().zip(["line 13", "line 14", "1 material with a texture", "`lost`"]) {
        assert!(note.contains(words), "{note}");
    }
}

#[test]
fn a_library_is_read_once_and_notes_are_few() {
    let lines = |count: usize, line: &str| (0..count).map(|i| line.replace('#', &i.to_string())).collect::<String>();
    let triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\n";
    let text = lines(1000, "mtllib a.mtl\n") + &lines(50, "mtllib ./a.mtl a.mtl\nmtllib a.mtl ././a.mtl\n") + triangle;
    assert_eq!(with_library(&text, b"newmtl a\nKd x\n").notes.len(), 1);
    let notes = obj(&(lines(1000, "mtllib b#.mtl\n") + triangle)).notes;
    assert!(notes.len() == 13 && notes[12].ends_with("more notes on this file"), "{notes:?}");
    assert_eq!(obj(&format!("mtllib a.mtl b.mtl\n{triangle}")).notes.len(), 3);
    let outside = obj(&format!("mtllib ../a.mtl\nmtllib /etc/hosts\n{triangle}")).notes;
    assert!(outside[..2].iter().all(|note| note.contains("outside the folder")), "{outside:?}");
    // A later material replaces all values of an earlier material with the same name.
    let twice = b"newmtl a\nKd 1 0 0\nKs 1 1 1\nmap_Kd a.png\nnewmtl a\nKd 0 1 0\n";
    let model = with_library(triangle, twice);
    assert_eq!(model.materials, [Material { diffuse: Vec3::Y, ..Material::named("a") }]);
    assert!(model.notes.is_empty(), "{:?}", model.notes);
    // The note about textures is exempt from the limit on the number of notes.
    let textured = format!("newmtl a\n{}map_Kd a.png\n", lines(20, "Kd #x\n"));
    let notes = with_library(triangle, textured.as_bytes()).notes;
    assert!(notes.iter().any(|note| note.starts_with("1 material with a texture")), "{notes:?}");
}

#[test]
fn marks_line_ends_and_comments_do_not_hide_vertices() {
    let plain = obj(&format!("{SQUARE}f 1 2 3\n"));
    for text in [
        format!("\u{feff}{SQUARE}f 1 2 3\n"),
        format!("{SQUARE}f 1 2 3\n").replace('\n', "\r"),
        format!("{SQUARE}f 1 2 3\n").replace('\n', "\r\n"),
        format!("# C:\\meshes\\\n{SQUARE}# \\\nf 1 2 3 # \\\n"),
        format!("{SQUARE}f 1 2 3").replace("v 9 9 9", "v 9 9 \\\r\n9 # end \\"),
    ] {
        assert_eq!(obj(&text), plain, "{text:?}");
    }
    let wide: Vec<u8> = SQUARE.encode_utf16().flat_map(u16::to_le_bytes).collect();
    assert_refused("a.obj", &wide, &["line 1:", "UTF-16"]);
}

#[test]
fn elements_other_than_faces_are_reported_and_a_material_may_have_no_name() {
    let model = obj(&format!("{SQUARE}l 1 2\np 1\nf 1 2 3\ncurv 0 1 1 2\no name\n"));
    assert_eq!(model.notes, ["3 statements of points, lines, curves or surfaces: ignored"]);
    let text = format!("{SQUARE}usemtl red\nf 1 2 3\nusemtl\nf 1 2 3\n");
    let model = with_library(&text, b"newmtl red\nKd 1 0 0\nnewmtl\nKd 0 1 0\n");
    assert_eq!((colours(&model), model.notes), (vec![Vec3::X, Vec3::Y], vec![]));
}

#[test]
fn lines_without_a_known_keyword_are_reported() {
    let model = obj(&format!("{SQUARE}vertex 1 2 3\nfoo\nf 1 2 3\nvt 0 0\ncstype bezier\n"));
    assert_eq!(model.notes, ["2 lines without an OBJ keyword are ignored; the first is line 6: `vertex 1 2 3`"]);
    let html = b"\n<!DOCTYPE html>\n<p>404</p>\n";
    assert_refused("a.obj", html, &["line 2: `<!DOCTYPE html>`", "OBJ keyword", "another format"]);
    assert_refused("a.obj", b"", &["has no triangles"]);
    assert_refused("a.obj", b"v 1 2 3\np 1\nf 1 1\n", &["has no triangles", "no face has three corners"]);
}

#[test]
fn malformed_files_are_refused_with_their_line() {
    for (text, words) in [
        ("v 0 0 0\nv 1 0\n", ["a.obj, line 2:", "three finite numbers are needed: `v 1 0`"]),
        ("v 0 0 x\n", ["line 1:", "three finite numbers are needed: `v 0 0 x`"]),
        ("v 0 0 0\nvn 0 \\\n0\nf 1 1 1\n", ["line 2:", "three numbers are needed: `vn 0  0`"]),
        ("v 0 0 nan\n", ["line 1:", "three finite numbers are needed: `v 0 0 nan`"]),
        ("v 0 0 1e39\n", ["line 1:", "finite numbers"]),
        ("v 0 0 0\nf 0 1 1\n", ["line 2:", "vertex index 0"]),
        ("v 0 0 0\nf 1 1 2\nf 1 1 1\n", ["line 2:", "vertex 2, but the file has only 1"]),
        ("v 0 0 0\nf 1 1 -2\n", ["line 2:", "-2 precedes the first of the 1"]),
        ("v 0 0 0\nf 1//1 1//1 1//1\n", ["line 2:", "normal 1, but the file has only 0"]),
        ("v 0 0 0\nf 1//0 1//1 1//1\n", ["line 2:", "normal index 0"]),
        ("v 0 0 0\nf 1 1 5000000000\n", ["line 2:", "vertex 5000000000 exceeds"]),
        ("v 0 0 0\nf 1 1 99999999999999999999\n", ["line 2:", "not a vertex index"]),
        ("v 0 0 0\nf 1 1 -9223372036854775808\n", ["line 2:", "precedes"]),
        ("v 0 0 0\nvn 0 0 1\nf 1 1 1/1/1/1\n", ["line 3:", "more than three indices"]),
        ("v 0 0 0\nf 1 1 1.5\n", ["line 2:", "`1.5` is not a vertex index"]),
        ("v 0 0 0\nf 1 / 1\n", ["line 2:", "`` is not a vertex index"]),
    ] {
        assert_refused("a.obj", text.as_bytes(), &words);
    }
    assert_refused("a.obj", b"v 0 0 \xff\xfe\n", &["line 1:", "three finite numbers"]);
    // A name may contain bytes that are not UTF-8.
    assert!(load_files(&[("a.obj", b"# caf\xe9\nv 0 0 0\nusemtl \xe9\nf 1 1 1\n")]).is_ok());
}

#[test]
fn what_tobj_misreads_is_read() {
    let plain = obj(&format!("{SQUARE}f 1 2 3\n"));
    for statement in [
        "v 1 1 0 1",
        "v 1 1 0 0.5 0.5 0.5",
        "v 1 1 0 0.5 0.5 0.5 1",
        "v 1 1 0 # a comment",
        "v 1 1 0 #",
        "# caf\u{e9}\nv 1 1 0",
        "v\t1  1\t0 ",
        "l 1 2 1\nv 1 1 0",
        "usemtl default\nv 1 1 0",
        "g\nv 1 1 0",
        "vt 0 x\nv 1 1 0",
    ] {
        assert_eq!(obj(&format!("{}f 1 2 3\n", SQUARE.replace("v 1 1 0", statement))).triangles, plain.triangles);
    }
    assert_eq!(obj("f 1/ 2/ 3/9/\ng a\nf 3 2 1\nv 0 0 0\nv 1 0 0\nv 0 1 0\n").triangles, [[0, 1, 2], [2, 1, 0]]);

    let weights = "v 2 0 0 2\nv 0 2 0 0\nv 0 0 2 x\nv 1 1 1 1.0\n";
    let model = obj(&format!("{weights}f 1 2 3 4\n"));
    assert_eq!(model.positions[..2], [Vec3::X * 2.0, Vec3::Y * 2.0]);
    assert_eq!(model.notes[0], "3 weights w other than 1 in statements `v`: ignored");

    // tobj panics on these normal indices.
    for (normal, words) in [
        ("-4", "normal index -4 precedes the first of the 3"),
        ("6148914691236517206", "normal 6148914691236517206 exceeds the limit of a mesh"),
        ("9", "normal 9, but the file has only 3"),
    ] {
        let text = format!("{SQUARE}{}f 1//1 2//{normal} 3//1\n", "vn 0 0 1\n".repeat(3));
        assert_refused("a.obj", text.as_bytes(), &["line 9:", words]);
    }
    // tobj treats U+00A0 and U+000B as white space.
    for text in ["v 1 2\u{a0}3 4\n", "v \u{a0} \u{a0} \u{a0}\n", "v 1 2\u{b}3 4\n"] {
        assert_refused("a.obj", text.as_bytes(), &["line 1:", "three finite numbers are needed"]);
    }
    let face = |corners: usize| format!("v 0 0 0\nf{}\n", " 1".repeat(corners));
    assert_eq!(obj(&face(1 << 20)).triangles.len(), (1 << 20) - 2);
    assert_refused("a.obj", face((1 << 20) + 1).as_bytes(), &["line 2:", "more than 1048576 corners"]);
}

#[test]
fn vertices_are_the_same_in_all_parts_of_a_large_file() {
    const SIDE: u32 = 200;
    let mut text = String::from("mtllib none.mtl\nv 5 5 5\nvn 5 5 5\n");
    let positions: Vec<_> = (0..SIDE * SIDE).map(|i| Vec3::new((i % SIDE) as f32, (i / SIDE) as f32, 0.5)).collect();
    let normals: Vec<_> = (0..SIDE).map(|i| Vec3::new(i as f32, 1.0, 0.0)).collect();
    positions.iter().for_each(|p| text += &format!("v {} {} {}\n", p.x, p.y, p.z));
    normals.iter().for_each(|n| text += &format!("vn {} {} {}\n", n.x, n.y, n.z));
    let (mut triangles, mut normal_indices, mut material_of) = (vec![], vec![], vec![]);
    // Faces alternate between distant rows, because models must share vertices.
    for i in 0..(SIDE - 1) * (SIDE - 1) {
        let (row, column) = (i * 7 % (SIDE - 1), i / (SIDE - 1));
        let a = row * SIDE + column;
        let corners = [a, a + 1, a + SIDE + 1, a + SIDE];
        let is_smooth = i % 3 > 0;
        if i % 1000 == 0 {
            text += &format!("g {i}\nusemtl m{}\n", i % 3000);
        }
        let corner = |corner: u32| match is_smooth {
            true => format!(" {}//{}", corner + 2, column + 2),
            false => format!(" -{}/1", SIDE * SIDE - corner),
        };
        text += &format!("f{}\n", corners.map(corner).concat());
        let [a, b, c, d] = corners;
        triangles.extend([[a, b, c], [a, c, d]]);
        normal_indices.extend([[if is_smooth { column + 1 } else { Model::FLAT }; 3]; 2]);
        material_of.extend([i / 1000 % 3; 2]);
    }
    let model = obj(&text);
    assert_eq!(model.positions, positions);
    // `model.normals[0]` is `vn 5 5 5`: the loader replaces missing normal indices by 1.
    assert_eq!(model.normals[1..], normals[..SIDE as usize - 1]);
    assert!(model.triangles == triangles && model.normal_indices == normal_indices && model.material_of == material_of);
}

#[test]
fn what_tobj_misreads_in_a_library_is_read() {
    let read = |mtl: &[u8]| with_library(&format!("{SQUARE}usemtl a # red\nf 1 2 3\n"), mtl);
    let red = Material { diffuse: Vec3::X, ..Material::named("a") };
    for mtl in [
        "newmtl a # red\nKd 1 0 0 # full\n",
        "newmtl a\r\nKd 1 0 0\r\n",
        "\u{feff}newmtl a\rKd 1 0 0\r",
        "newmtl\ta\nKd 1 0 0 0.5\n",
    ] {
        let model = read(mtl.as_bytes());
        assert_eq!((&model.materials[..], &model.notes[..]), (&[red.clone()][..], &[][..]), "{mtl:?}");
    }
    let bad_colours = ["Ka", "Ka 0.5 0.5", "Ka x", "Ka 0 0 nan", "Ka 1e999", "Ka \u{a0} \u{a0} \u{a0}"];
    for bad in bad_colours.into_iter().chain(["Ks spectral a.rfl", "Ns", "Ns inf"]) {
        let Model { materials, notes, .. } =
            read(format!("newmtl a\n{bad}\nKd 1 0 0\nillum x\nd\nmap_Kd\n").as_bytes());
        assert_eq!(materials, std::slice::from_ref(&red), "{bad:?}");
        assert!(notes.len() == 1 && notes[0].contains("line 2: `"), "{notes:?}");
    }
    assert_eq!(colours(&read(b"newmtl a\nKd 0.5\nNs -1\nKe \xff\n")), [Vec3::splat(0.5)]);
    // The `#` in `Material #2` does not begin a comment.
    let text = format!("{SQUARE}usemtl Material #2\nf 1 2 3\nusemtl Material #3\nf 1 2 3\n");
    let model = with_library(&text, b"newmtl Material #2\nKd 1 0 0\nnewmtl Material #3\nKd 0 1 0\n");
    assert_eq!(colours(&model), [Vec3::X, Vec3::Y]);
}

/// Names that are not UTF-8 are compared as bytes.
#[test]
#[cfg(target_os = "linux")]
fn names_need_not_be_text() {
    use std::ffi::OsStr;
    use std::fs;
    use std::os::unix::ffi::OsStrExt as _;

    use super::load;

    let folder = tempfile::tempdir().unwrap();
    let path = |name: &[u8]| folder.path().join(OsStr::from_bytes(name));
    let faces = b"mtllib gr\xfcn.mtl\nusemtl gr\xfcn\nf 1 2 3\nusemtl gr\xf6n\nf 1 2 3\n";
    fs::write(path(b"a.obj"), [SQUARE.as_bytes(), faces].concat()).unwrap();
    let missing = load(&path(b"a.obj")).unwrap();
    assert!(missing.notes[0].contains("gr\\xfcn.mtl"), "{:?}", missing.notes);
    fs::write(path(b"gr\xfcn.mtl"), b"newmtl gr\xfcn\nKd 0 1 0\nnewmtl gr\xf6n\nKd 0 0 1\n").unwrap();
    let model = load(&path(b"a.obj")).unwrap();
    assert_eq!((colours(&model), model.material_of, model.notes), (vec![Vec3::Y, Vec3::Z], vec![0, 1], vec![]));
}
