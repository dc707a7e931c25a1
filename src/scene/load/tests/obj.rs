use glam::Vec3;

use super::{assert_refused, corners, load_files};
use crate::scene::{Material, Model};

fn obj(text: &str) -> Model {
    load_files(&[("a.obj", text.as_bytes())]).unwrap()
}

const SQUARE: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 9 9 9\n";

#[test]
fn polygons_are_fans_and_vertices_keep_their_number() {
    let model = obj(&format!("{SQUARE}g a\nf 1 2 3 4\ng b\nl 1 2\np 3\nf 4 3 2\nf 1 2\n"));
    assert_eq!(model.triangles, [[0, 1, 2], [0, 2, 3], [3, 2, 1]]);
    assert_eq!(model.positions.len(), 5);
    assert!(model.normals.is_empty() && model.normal_indices.is_empty() && model.material_of.is_empty());
    assert_eq!(model.materials, [Material::named("default")]);
    let left_out =
        ["1 face with fewer than three corners is left out", "2 points, lines, curves or surfaces are left out"];
    assert_eq!(model.notes, left_out);
}

#[test]
fn indices_may_be_negative_forward_and_continued() {
    assert_eq!(obj(&format!("{SQUARE}f -5 -4 -3\n")).triangles, [[0, 1, 2]]);
    assert_eq!(obj(&format!("f 1 2 3 # first\r\n{SQUARE}")).triangles, [[0, 1, 2]]);
    assert_eq!(obj(&format!("{SQUARE}f 1 2 \\\n3 4 \\")).triangles, [[0, 1, 2], [0, 2, 3]]);
    // A negative index counts the vertices so far, not those of the file.
    assert_eq!(obj("v 0 0 0\nv 1 0 0\nv 1 1 0\nf -3 -2 -1\nv 5 5 5\n").triangles, [[0, 1, 2]]);
}

#[test]
fn corners_have_normals_or_the_face_is_flat() {
    let model = obj(&format!("{SQUARE}vt 0 0\nvn 0 0 1\nvn 0 1 0\nf 1//1 2//2 3//-1\nf 1/1/1 2/1/1 3/1\nf 1 2 3\n"));
    assert_eq!(model.normal_indices, [[0, 1, 1], [Model::FLAT; 3], [Model::FLAT; 3]]);
    assert_eq!(model.normals, [Vec3::Z, Vec3::Y]);
    // Normals of length zero are reported.
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
    assert!(
        model.notes[0].contains("line 13") && model.notes[1].contains("line 14") && model.notes[3].contains("`lost`")
    );
    assert!(model.notes[2].starts_with("1 material has a texture"), "{}", model.notes[2]);
}

#[test]
fn a_library_is_read_once_and_notes_are_few() {
    let lines = |count: usize, line: &str| (0..count).map(|i| line.replace('#', &i.to_string())).collect::<String>();
    let triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\n";
    let bad = ("a.mtl", &b"newmtl a\nKd x\n"[..]);
    let text = lines(1000, "mtllib a.mtl\n") + &lines(50, "mtllib ./a.mtl a.mtl\nmtllib a.mtl ././a.mtl\n") + triangle;
    let model = load_files(&[("a.obj", text.as_bytes()), bad]).unwrap();
    assert_eq!(model.notes.len(), 1, "{:?}", model.notes);
    let model = obj(&(lines(1000, "mtllib b#.mtl\n") + triangle));
    assert_eq!(model.notes.len(), 14, "{:?}", model.notes);
    assert!(model.notes[12].contains("are not followed"), "{:?}", model.notes);
    assert!(model.notes[13].ends_with("more notes on this file are left out"), "{:?}", model.notes);
    // A line names several files.
    assert_eq!(obj(&format!("mtllib a.mtl b.mtl\n{triangle}")).notes.len(), 3);
    let outside = obj(&format!("mtllib ../a.mtl\nmtllib /etc/hosts\n{triangle}"));
    assert!(outside.notes[..2].iter().all(|note| note.contains("not below the folder")), "{:?}", outside.notes);
    // The later of two materials with one name counts, whole.
    let twice = ("a.mtl", &b"newmtl a\nKd 1 0 0\nKs 1 1 1\nmap_Kd a.png\nnewmtl a\nKd 0 1 0\n"[..]);
    let model = load_files(&[("a.obj", format!("mtllib a.mtl\n{triangle}").as_bytes()), twice]).unwrap();
    assert_eq!(model.materials, [Material { diffuse: Vec3::Y, ..Material::named("a") }]);
    assert!(model.notes.is_empty(), "{:?}", model.notes);
    // Notes that stand for many occurrences follow all others.
    let textured = lines(20, "Kd #x\n") + "map_Kd a.png\n";
    let textured = ("a.mtl", [&b"newmtl a\n"[..], textured.as_bytes()].concat());
    let text = format!("mtllib a.mtl\n{triangle}");
    let model = load_files(&[("a.obj", text.as_bytes()), (textured.0, &textured.1)]).unwrap();
    assert!(model.notes.iter().any(|note| note.starts_with("1 material has a texture")), "{:?}", model.notes);
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
    assert_eq!(model.notes, ["3 points, lines, curves or surfaces are left out"]);
    let library = ("a.mtl", &b"newmtl red\nKd 1 0 0\nnewmtl\nKd 0 1 0\n"[..]);
    let text = format!("mtllib a.mtl\n{SQUARE}usemtl red\nf 1 2 3\nusemtl\nf 1 2 3\n");
    let model = load_files(&[("a.obj", text.as_bytes()), library]).unwrap();
    assert_eq!(model.materials.iter().map(|m| m.diffuse).collect::<Vec<_>>(), [Vec3::X, Vec3::Y]);
    assert!(model.notes.is_empty(), "{:?}", model.notes);
}

#[test]
fn lines_without_a_known_keyword_are_reported() {
    let model = obj(&format!("{SQUARE}vertex 1 2 3\nfoo\nf 1 2 3\nvt 0 0\ncstype bezier\n"));
    assert_eq!(model.notes, ["2 lines without a keyword of OBJ are passed over, the first is line 6: `vertex 1 2 3`"]);
    let html = b"\n<!DOCTYPE html>\n<p>404</p>\n";
    assert_refused("a.obj", html, &["line 2: `<!DOCTYPE html>`", "no keyword of OBJ", "another format"]);
    assert_refused("a.obj", b"", &["holds no triangles"]);
    assert_refused("a.obj", b"v 1 2 3\np 1\nf 1 1\n", &["no triangles: 1 vertices, 1 faces", "1 points"]);
}

#[test]
fn malformed_files_are_refused_with_their_line() {
    for (text, words) in [
        ("v 0 0 0\nv 1 0\n", ["a.obj, line 2:", "three numbers"]),
        ("v 0 0 x\n", ["line 1:", "`x` is not a number"]),
        ("v 0 0 nan\n", ["line 1:", "vertex 1 is not finite"]),
        ("v 0 0 0\nv 0 -inf 0\n", ["line 2:", "vertex 2 is not finite"]),
        ("v 0 0 1e39\n", ["line 1:", "not finite"]),
        ("v 0 0 0\nf 0 1 1\n", ["line 2:", "vertex index 0"]),
        ("v 0 0 0\nf 1 1 2\nf 1 1 1\n", ["line 2:", "vertex 2, but the file has only 1"]),
        ("v 0 0 0\nf 1 1 -2\n", ["line 2:", "-2 reaches before the first of the 1"]),
        ("v 0 0 0\nf 1//1 1//1 1//1\n", ["line 2:", "normal 1, but the file has only 0"]),
        ("v 0 0 0\nf 1//0 1//1 1//1\n", ["line 2:", "normal index 0"]),
        ("v 0 0 0\nf 1 1 5000000000\n", ["line 2:", "vertex 5000000000 is more"]),
        ("v 0 0 0\nf 1 1 99999999999999999999\n", ["line 2:", "not a vertex index"]),
        ("v 0 0 0\nf 1 1 -9223372036854775808\n", ["line 2:", "reaches before"]),
        ("v 0 0 0\nf 1 1 1/1/1/1\n", ["line 2:", "more than three indices"]),
        ("v 0 0 0\nf 1 1 1.5\n", ["line 2:", "`1.5` is not a vertex index"]),
        ("v 0 0 0\nf 1 / 1\n", ["line 2:", "`` is not a vertex index"]),
    ] {
        assert_refused("a.obj", text.as_bytes(), &words);
    }
    assert_refused("a.obj", b"v 0 0 \xff\xfe\n", &["line 1:", "is not a number"]);
    // In a name a stray byte does no harm.
    assert!(load_files(&[("a.obj", b"# caf\xe9\nv 0 0 0\nusemtl \xe9\nf 1 1 1\n")]).is_ok());
}

#[test]
fn the_geometry_is_what_tobj_reads() {
    let mut text = String::new();
    for i in 0..40 {
        text += &format!(
            "v {} {} {}\nvn {i} 1 0\nvt 0.5 {i}\n",
            i as f32 * 0.1,
            (i * 7 % 11) as f32 / 3.0,
            -1.5e-3 * i as f32
        );
    }
    for i in 0..36 {
        let (a, b) = (i + 1, i - 38);
        text += &match i % 4 {
            0 => format!("g part {i}\nf {a}/{a}/{a} {b}/1/2 {a}/2/{b}\n"),
            1 => format!("f {a}/1/1 {b}/1/1 {}/1/3 {}/1/4\n", a + 1, a + 2),
            // There and back: without area, it becomes a fan in both.
            2 => format!("o thing\nf {a}/1/5 {b}/1/1 {c}/1/3 1/1/4 {c}/1/1 {}/1/2\nl 1 2\n", a + 2, c = a + 1),
            _ => format!("usemtl m{i}\nf {a}/1/1 {b}/1/1 {}/1/3\n", a + 1),
        };
    }
    let ours = obj(&text);
    let options = tobj::LoadOptions { triangulate: true, ignore_lines: true, ..Default::default() };
    let no_materials = |_: &std::path::Path| Ok(Default::default());
    let (models, _) = tobj::load_obj_buf(&mut text.as_bytes(), &options, no_materials).unwrap();
    let vectors = |list: &[f32], indices: &[u32]| -> Vec<Vec3> {
        indices.iter().map(|&i| Vec3::from_slice(&list[3 * i as usize..])).collect()
    };
    let theirs: Vec<_> = models.iter().flat_map(|m| vectors(&m.mesh.positions, &m.mesh.indices)).collect();
    assert_eq!(corners(&ours).as_flattened(), theirs);
    let theirs: Vec<_> = models.iter().flat_map(|m| vectors(&m.mesh.normals, &m.mesh.normal_indices)).collect();
    let normals: Vec<_> = ours.normal_indices.as_flattened().iter().map(|&i| ours.normals[i as usize]).collect();
    assert_eq!(normals, theirs);
}
