use glam::Vec3;

use super::{assert_refused, face_normals, load_files};
use crate::scene::Model;

/// A quadrilateral and a triangle.
pub(super) const ASCII: &str = "ply\nformat ascii 1.0\ncomment by hand\nelement vertex 5\nproperty float x\nproperty double y\n\
    property float z\nproperty uchar red\nproperty list uchar int tags\nelement face 2\nproperty uchar flags\n\
    property list uchar int vertex_indices\nelement edge 1\nproperty int vertex1\nproperty int vertex2\nend_header\n\
    0 0 0 255 0\n1 0 0 255 2 7 8\n1 1 0 0 0\n0 1 -0.5e0 0 1 3\n9 9 9 0 0\n1 4 0 1 2 3\n0 3 2 1 0\n0 1\n";

fn ply(bytes: &[u8]) -> Model {
    load_files(&[("a.ply", bytes)]).unwrap()
}

/// Returns the mesh of [`ASCII`] as binary PLY. `length` and `corner` are the names of PLY types.
pub(super) fn binary(big: bool, length: &str, corner: &str) -> Vec<u8> {
    let order = if big { "big" } else { "little" };
    let mut bytes = format!(
        "ply\nformat binary_{order}_endian 1.0\nelement vertex 5\nproperty double x\nproperty double y\nproperty double z\n\
         property float nx\nproperty float ny\nproperty float nz\nproperty short extra\n\
         element face 2\nproperty list {length} {corner} vertex_index\nend_header\n"
    )
    .into_bytes();
    let mut put = |little: &[u8]| match big {
        true => bytes.extend(little.iter().rev()),
        false => bytes.extend(little),
    };
    for [x, y, z] in [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, -0.5], [9.0, 9.0, 9.0_f64]] {
        [x, y, z].iter().for_each(|c| put(&c.to_le_bytes()));
        [0.0, 0.0, 1.0_f32].iter().for_each(|c| put(&c.to_le_bytes()));
        put(&[1, 2]);
    }
    let width = |kind: &str| match kind.trim_start_matches('u') {
        "char" => 1,
        "short" => 2,
        _ => 4,
    };
    for face in [&[0, 1, 2, 3_u32][..], &[2, 1, 0]] {
        put(&(face.len() as u32).to_le_bytes()[..width(length)]);
        face.iter().for_each(|corner_number| put(&corner_number.to_le_bytes()[..width(corner)]));
    }
    bytes
}

#[test]
fn text_with_more_than_a_mesh() {
    let model = ply(ASCII.as_bytes());
    assert_eq!(model.triangles, [[0, 1, 2], [0, 2, 3], [2, 1, 0]]);
    assert_eq!(model.positions.len(), 5, "unused vertices stay");
    assert_eq!(model.positions[3], Vec3::new(0.0, 1.0, -0.5));
    assert!(model.normals.is_empty() && model.normal_indices.is_empty());
    let latin = ASCII.replace("by hand", "caf?").bytes().map(|byte| if byte == b'?' { 0xe9 } else { byte }).collect();
    for (what, file) in [
        ("line ends of DOS", ASCII.replace('\n', "\r\n").into()),
        ("line ends of old Macs", ASCII.replace('\n', "\r").into()),
        ("no last line end", ASCII.trim_end().into()),
        ("a byte order mark", [b"\xef\xbb\xbf", ASCII.as_bytes()].concat()),
        ("a comment in Latin-1", latin),
        ("a long list", ASCII.replace("2 7 8", &format!("300{}", " 7".repeat(300))).into()),
    ] {
        assert_eq!(ply(&file), model, "{what}");
    }
}

#[test]
fn faces_may_stand_before_vertices_and_be_concave() {
    let faces = "element face 1\nproperty list uchar int vertex_indices\n";
    let vertices = "element vertex 4\nproperty float x\nproperty float y\nproperty float z\n";
    let rows = "0 0 0\n2 -1 0\n0.5 0 0\n2 1 0\n";
    let file = format!("ply\nformat ascii 1.0\n{faces}{vertices}end_header\n4 0 1 2 3\n{rows}");
    let model = ply(file.as_bytes());
    assert_eq!(model.triangles.len(), 2);
    assert!(face_normals(&model).iter().all(|normal| normal.z > 0.0), "{:?}", model.triangles);
    let none = file.replace("face 1", "face 0").replace("4 0 1 2 3\n", "");
    assert_refused("a.ply", none.as_bytes(), &["no triangles: 4 vertices", "`face`", "point clouds"]);
}

#[test]
fn binary_of_both_orders_and_all_integers() {
    for big in [false, true] {
        for length in ["char", "uchar", "short", "ushort", "int", "uint"] {
            for corner in ["char", "uchar", "short", "ushort", "int", "uint"] {
                let model = ply(&binary(big, length, corner));
                assert_eq!(model.triangles, [[0, 1, 2], [0, 2, 3], [2, 1, 0]], "{big} {length} {corner}");
                assert_eq!(model.positions[3], Vec3::new(0.0, 1.0, -0.5));
                assert_eq!((model.normals.len(), model.normals[4]), (5, Vec3::Z));
                assert_eq!(model.normal_indices, model.triangles);
            }
        }
    }
}

/// `elements` is the part of the header that declares `numbers`.
fn with_vertices(elements: &str, numbers: &[i32]) -> Vec<u8> {
    let vertices = "element vertex 7\nproperty char x\nproperty char y\nproperty char z\n";
    let header = format!("ply\nformat binary_little_endian 1.0\n{vertices}{elements}end_header\n");
    let rows = (0..21).chain(numbers.iter().flat_map(|number| number.to_le_bytes()));
    header.into_bytes().into_iter().chain(rows).collect()
}

#[test]
fn strips_begin_anew_at_minus_one_and_their_winding_alternates() {
    let strips = |rows: usize| format!("element tristrips {rows}\nproperty list int int vertex_indices\n");
    let face = "element face 1\nproperty list int int vertex_index\n";
    let small = "1 face with fewer than three corners: ignored";
    for (elements, numbers, triangles, notes) in [
        (strips(1), &[8, 0, 1, 2, 3, -1, 4, 5, 6][..], &[[0, 1, 2], [2, 1, 3], [4, 5, 6]][..], &[][..]),
        // A strip never continues in the next row.
        (strips(2), &[5, 0, 1, 2, 3, 4, 3, 4, 5, 6], &[[0, 1, 2], [2, 1, 3], [2, 3, 4], [4, 5, 6]], &[]),
        // Strips and faces keep the order of the file.
        (strips(1) + face, &[3, 0, 1, 2, 3, 4, 5, 6], &[[0, 1, 2], [4, 5, 6]], &[]),
        // The strip 3, 4 gives a note. Empty strips give no note.
        (strips(1), &[9, -1, 3, 4, -1, -1, 0, 1, 2, -1], &[[0, 1, 2]], &[small]),
    ] {
        let model = ply(&with_vertices(&elements, numbers));
        assert_eq!(model.triangles, triangles, "{numbers:?}");
        assert_eq!(model.notes, notes, "{numbers:?}");
    }
    // The limit of corners per face does not apply to strips.
    let long: Vec<i32> = [2_000_000].into_iter().chain((0..2_000_000).map(|i| i % 7)).collect();
    assert_eq!(ply(&with_vertices(&strips(1), &long)).triangles.len(), 1_999_998);

    for (elements, numbers, words) in [
        (strips(1), &[4, 0, 1, 2, -2][..], ["tristrips 0:", "corner -2 is not one of the 7"]),
        (strips(1), &[4, 0, 1, 2, 7], ["tristrips 0:", "corner 7"]),
        (strips(1), &[-1, 0, 1, 2], ["tristrips 0:", "-1 entries"]),
        (strips(1), &[9, 0, 1, 2], ["tristrips 0:", "truncated"]),
        (strips(1), &[2, 0, 1], ["it has", "no triangles"]),
        (strips(1).replace("int int", "int float"), &[3, 0, 0, 0], ["line 8:", "a list of integers"]),
        (strips(1).replace("indices", "colours"), &[3, 0, 1, 2], ["element tristrips:", "`vertex_indices`"]),
        (face.into(), &[3, 0, 1, -1], ["face 0:", "corner -1"]),
    ] {
        assert_refused("a.ply", &with_vertices(&elements, numbers), &words);
    }
}

#[test]
fn every_truncation_is_refused() {
    let text = ASCII.trim_end();
    for (file, data) in [(text.as_bytes().to_vec(), text.len() - 2), (binary(false, "uchar", "int"), usize::MAX)] {
        for end in 0..file.len().min(data) {
            assert_refused("a.ply", &file[..end], &["a.ply"]);
        }
    }
    let file = binary(true, "uint", "int");
    assert_refused("a.ply", &file[..file.len() - 1], &["face 1:", "truncated"]);
}

#[test]
fn malformed_files_are_refused_by_name_and_number() {
    let cases = [
        ("ply\n", "plx\n", ["line 1:", "begins with the line `ply`"]),
        ("vertex 5", "vertex 50", ["element vertex:", "50 rows"]),
        ("vertex 5", "vertex 6", ["vertex 5:", "too few"]),
        ("face 2", "face 1", ["edge 0:", "too many"]),
        ("edge 1\n", "edge 0\n", ["4 bytes follow", "counts"]),
        ("face 2", "face 4000000000000", ["element face:", "truncated"]),
        ("face 2", "face 99999999999999999999999", ["line 10:", "not a line of a PLY header"]),
        ("ascii 1.0", "ascii 99999999999999999999999.0", ["line 2:", "not a line of a PLY header"]),
        ("element face 2", "element faces 2", ["no triangles: 5 vertices", "point clouds"]),
        ("element vertex 5", "element points 5", ["no element `vertex`", "no mesh"]),
        ("double y", "double w", ["element vertex:", "`y` is missing"]),
        ("double y", "list uchar int y", ["line 6:", "a coordinate is a number"]),
        ("vertex_indices", "indices", ["element face:", "one list of corners, with the name `vertex_indices`"]),
        ("uchar int vertex_indices", "uchar float vertex_indices", ["line 12:", "a list of integers"]),
        ("property uchar flags", "property list uchar int vertex_index", ["element face:", "one list of corners"]),
        ("uchar flags", "uchar vertex_indices", ["line 11:", "a list of integers"]),
        ("uchar flags", "list uchar int vertex_indices", ["line 12:", "declared twice"]),
        ("list uchar int tags", "list float int tags", ["line 9:", "a length is an integer"]),
        ("format ascii 1.0", "comment ascii 1.0", ["line 4:", "not a line of a PLY header"]),
        ("element edge", "element vertex", ["line", "declared twice"]),
        ("end_header", "end_head", ["line 16:", "not a line of a PLY header"]),
        ("end_header", "comment", ["line 17:", "not a line of a PLY header"]),
        ("\n1 4 0 1 2 3\n", "\n1 9999999 0 1 2 3\n", ["face 0:", "9999999 entries: the limit is 1048576"]),
        ("\n1 4 0 1 2 3\n", "\n1 4 0 1 2 5\n", ["face 0:", "corner 5 is not one of the 5"]),
        ("\n1 4 0 1 2 3\n", "\n1 4 0 1 2 -1\n", ["face 0:", "corner -1"]),
        ("\n1 4 0 1 2 3\n", "\n1 5 0 1 2 3\n", ["face 0:", "too few"]),
        ("\n1 4 0 1 2 3\n", "\n1 -4 0 1 2 3\n", ["face 0:", "-4 entries"]),
        ("\n1 1 0", "\n1 x 0", ["vertex 2:", "numbers"]),
        ("\n1 1 0", "\n1e39 1 0", ["vertex 2:", "finite"]),
    ];
    for (from, to, words) in cases {
        assert!(ASCII.contains(from), "{from}");
        assert_refused("a.ply", ASCII.replacen(from, to, 1).as_bytes(), &words);
    }
    let [first_vertex, first_list] = [36 + 5 * 38, 36];
    for (file, from_end, bytes, words) in [
        (binary(false, "uint", "int"), first_list, &[0xff; 4][..], ["face 0:", "4294967295 entries"]),
        (binary(false, "uint", "int"), first_list, &[0, 1, 0, 0], ["face 0:", "truncated"]),
        (binary(true, "int", "int"), first_list, &[0xff; 4], ["face 0:", "-1 entries"]),
        (binary(false, "uint", "int"), first_vertex, &f64::NAN.to_le_bytes(), ["vertex 0:", "finite"]),
    ] {
        let mut file = file;
        let at = file.len() - from_end;
        file[at..at + bytes.len()].copy_from_slice(bytes);
        assert_refused("a.ply", &file, &words);
    }
}
