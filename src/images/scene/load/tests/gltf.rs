mod faults;
mod geometry;
mod tolerance;

use glam::Vec3;
use serde_json::{Value, json};

use super::{LoadError, assert_error, corners, face_normals, load_files};
use crate::scene::Model;

/// The corners and normals of a unit square, and the indices of two triangles as u8, u16 and u32.
fn data() -> Vec<u8> {
    let mut bytes = Vec::new();
    let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0_f32]];
    for vector in corners.iter().chain(&[[0.0, 0.0, 1.0]; 4]) {
        vector.iter().for_each(|c| bytes.extend(c.to_le_bytes()));
    }
    let indices = [0, 1, 2, 0, 2, 3_u8];
    bytes.extend(indices);
    bytes.extend([0, 0]);
    indices.iter().for_each(|&i| bytes.extend(u16::from(i).to_le_bytes()));
    indices.iter().for_each(|&i| bytes.extend(u32::from(i).to_le_bytes()));
    bytes
}

/// A document that places the square from `data` at one node. The file `a.bin` contains the bytes of `data`.
fn document() -> Value {
    let view = |offset, length| json!({"buffer": 0, "byteOffset": offset, "byteLength": length});
    let accessor = |view, component, kind, count| json!({"bufferView": view, "componentType": component, "type": kind, "count": count, "min": [0, 0, 0], "max": [1, 1, 0]});
    let indices = |view, component| accessor(view, component, "SCALAR", 6);
    let vectors = |view| accessor(view, 5126, "VEC3", 4);
    json!({
        "asset": {"version": "2.0"},
        "buffers": [{"uri": "a.bin", "byteLength": 140}],
        "bufferViews": [view(0, 48), view(48, 48), view(96, 6), view(104, 12), view(116, 24)],
        "accessors": [vectors(0), vectors(1), indices(2, 5121), indices(3, 5123), indices(4, 5125)],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "NORMAL": 1}, "indices": 3}]}],
        "nodes": [{"mesh": 0}],
        "scenes": [{"nodes": [0]}],
        "scene": 0
    })
}

/// A pointer without a leading slash is relative to the primitive.
fn changed(changes: &[(&str, Value)]) -> Vec<u8> {
    let mut document = document();
    for (pointer, value) in changes {
        let within = if pointer.starts_with('/') { "" } else { "/meshes/0/primitives/0/" };
        let pointer = format!("{within}{pointer}");
        let (parent, key) = pointer.rsplit_once('/').unwrap();
        match document.pointer_mut(parent).unwrap() {
            Value::Array(list) if key == "-" => list.push(value.clone()),
            Value::Array(list) => list[key.parse::<usize>().unwrap()] = value.clone(),
            parent => parent[key] = value.clone(),
        }
    }
    document.to_string().into_bytes()
}

fn loaded(document: &[u8]) -> Result<Model, LoadError> {
    load_files(&[("a.gltf", document), ("a.bin", &data())])
}

fn gltf(changes: &[(&str, Value)]) -> Model {
    loaded(&changed(changes)).unwrap()
}

fn refused(changes: &[(&str, Value)], words: &[&str]) {
    assert_error(loaded(&changed(changes)), "a.gltf", words);
}

pub(super) fn binary() -> Vec<u8> {
    let mut document = document();
    document["buffers"][0].as_object_mut().unwrap().remove("uri");
    let mut json = document.to_string().into_bytes();
    json.resize(json.len().next_multiple_of(4), b' ');
    let data = data();
    let mut bytes = b"glTF\x02\0\0\0".to_vec();
    bytes.extend((28 + json.len() as u32 + data.len() as u32).to_le_bytes());
    for (kind, chunk) in [(b"JSON", &json), (b"BIN\0", &data)] {
        bytes.extend((chunk.len() as u32).to_le_bytes());
        bytes.extend(kind);
        bytes.extend(chunk);
    }
    bytes
}

pub(super) fn texts() -> [Vec<u8>; 3] {
    let uri = format!("data:application/octet-stream;base64,{}", base64::encode(data()));
    let text =
        |changes: Vec<(&str, Value)>| changed(&[&changes[..], &[("/buffers/0/uri", uri.clone().into())]].concat());
    [vec![], geometry::skinned(), geometry::instanced_square()].map(text)
}

#[test]
fn buffers_lie_apart_or_within() {
    let model = gltf(&[]);
    assert_eq!(model.triangles, [[0, 1, 2], [0, 2, 3]]);
    assert_eq!(model.positions, [Vec3::ZERO, Vec3::X, Vec3::new(1.0, 1.0, 0.0), Vec3::Y]);
    assert_eq!((&model.normals[..], &model.normal_indices), (&[Vec3::Z; 4][..], &model.triangles));
    assert_eq!((model.materials.len(), model.material_of.len(), model.notes.len()), (1, 0, 0));
    assert_eq!(load_files(&[("a.glb", &binary())]).unwrap(), model);
    assert_eq!(load_files(&[("a.gltf", &texts()[0])]).unwrap(), model);
    let escaped = changed(&[("/buffers/0/uri", "a%20b.bin".into())]);
    assert_eq!(load_files(&[("a.gltf", &escaped), ("a b.bin", &data())]).unwrap(), model);
}

#[test]
fn indices_of_all_widths_and_none() {
    for accessor in [2, 4] {
        assert_eq!(gltf(&[("indices", accessor.into())]), gltf(&[]));
    }
    let three = [("/accessors/0/count", json!(3)), ("/accessors/1/count", json!(3))];
    let primitive = json!({"attributes": {"POSITION": 0}});
    let model = gltf(&[&three[..], &[("/meshes/0/primitives/0", primitive)]].concat());
    assert_eq!((model.triangles, model.normals.len()), (vec![[0, 1, 2]], 0));
}

#[test]
fn strips_and_fans_and_what_is_no_triangle() {
    for (mode, triangles) in [(5, [[0, 1, 2], [1, 3, 2]]), (6, [[0, 1, 2], [0, 2, 3]])] {
        let primitive = json!({"attributes": {"POSITION": 0, "_OWN": 1}, "mode": mode});
        assert_eq!(gltf(&[("/meshes/0/primitives/0", primitive)]).triangles, triangles, "{mode}");
    }
    for lines in 0..4 {
        refused(&[("mode", json!(lines))], &["no visible triangles", "no triangle primitive with positions"]);
        let primitive = json!({"attributes": {"POSITION": 0}, "mode": lines});
        let Model { triangles, notes, .. } = gltf(&[("/meshes/0/primitives/-", primitive)]);
        assert!(triangles.len() == 2 && notes[0].starts_with("1 primitive of points or lines"), "{notes:?}");
    }
}

#[test]
fn textures_and_morph_targets_are_reported() {
    let texture = json!({"index": 0});
    let changes = [
        ("/materials", json!([{"pbrMetallicRoughness": {"baseColorTexture": texture}}, {"normalTexture": texture}])),
        ("/textures", json!([{"source": 0}])),
        ("/images", json!([{"uri": "a.png"}])),
        ("material", json!(1)),
        ("targets", json!([{"POSITION": 0}])),
    ];
    let notes = gltf(&changes).notes;
    assert!(notes[0].starts_with("1 material with a texture"), "{notes:?}");
    assert!(notes[1].starts_with("1 primitive with morph"), "{notes:?}");
}

#[test]
fn transforms_accumulate_and_mirrors_turn_the_winding() {
    // The transforms map (x, y, z) to (1 + 2x, -y, 3z).
    let child = json!({"mesh": 0, "matrix": [-2, 0, 0, 0, 0, 1, 0, 0, 0, 0, 3, 0, 0, 0, 0, 1]});
    let parent = json!({"children": [0], "translation": [1, 0, 0], "rotation": [0, 0, 1, 0]});
    let model = gltf(&[("/nodes/0", child), ("/nodes/-", parent), ("/scenes/0/nodes", json!([1]))]);
    assert_eq!(model.positions[2], Vec3::new(3.0, -1.0, 0.0));
    assert_eq!(model.triangles, [[0, 2, 1], [0, 3, 2]]);
    assert_eq!(model.normal_indices, model.triangles);
    assert!(face_normals(&model).iter().all(|n| n.normalize() == Vec3::Z));
    assert!(model.normals.iter().all(|&n| n == Vec3::Z));
}

#[test]
fn normals_go_by_the_inverse_transpose() {
    // The tilt moves the square to the plane z = x. The stretch along x turns the normal (-1, 0, 1) to (-1, 0, 4).
    let tilt = json!({"mesh": 0, "matrix": [1, 0, 1, 0, 0, 1, 0, 0, -1, 0, 1, 0, 0, 0, 0, 1]});
    let stretch = json!({"children": [0], "scale": [4, 1, 1]});
    for mirror in [1.0, -1.0] {
        let top = json!({"children": [1], "scale": [1, mirror, 1]});
        let model = gltf(&[("/nodes", json!([tilt, stretch, top])), ("/scenes/0/nodes", json!([2]))]);
        let expected = Vec3::new(-1.0, 0.0, 4.0).normalize();
        for normal in model.normals.iter().copied().chain(face_normals(&model).iter().map(|n| n.normalize())) {
            assert!(normal.abs_diff_eq(expected, 1e-6), "{normal} {mirror}");
        }
    }
}

#[test]
fn one_mesh_at_several_nodes_and_accessors_shared() {
    let half = json!({"attributes": {"POSITION": 0}, "indices": 3, "material": 0});
    let model = gltf(&[
        ("/meshes/0/primitives/-", half),
        ("/nodes/-", json!({"mesh": 0, "translation": [0, 0, 5]})),
        ("/scenes/0/nodes", json!([1, 0])),
        ("/materials", json!([{"name": "blue", "pbrMetallicRoughness": {"baseColorFactor": [0, 0.5, 1, 0.5]}}])),
    ]);
    assert_eq!((model.positions.len(), model.normals.len(), model.triangles.len()), (8, 8, 8));
    assert_eq!(corners(&model)[0][0].z, 5.0, "the scene lists node 1 first");
    assert_eq!(model.material_of, [1, 1, 0, 0, 1, 1, 0, 0]);
    assert_eq!(model.normal_indices[2], [Model::FLAT; 3]);
    assert_eq!((model.materials[0].name.as_str(), model.materials[0].diffuse), ("blue", Vec3::new(0.0, 0.5, 1.0)));
    assert_eq!(model.materials[1].name, "default");
}

#[test]
fn without_a_default_scene_all_roots_are_shown() {
    let mut all = document();
    all.as_object_mut().unwrap().remove("scene");
    all["nodes"] = json!([{"mesh": 0}, {"children": [0]}, {"mesh": 0}]);
    let model = loaded(all.to_string().as_bytes()).unwrap();
    assert_eq!(model.triangles.len(), 4);
}

#[test]
fn sparse_accessors_with_and_without_a_base() {
    let sparse = |indices: Value| json!({"count": 2, "indices": {"bufferView": 2, "byteOffset": indices, "componentType": 5121}, "values": {"bufferView": 0, "byteOffset": 24}});
    // Elements 0 and 1 receive the coordinates of corners 2 and 3.
    let model = gltf(&[("/accessors/0/sparse", sparse(0.into()))]);
    assert_eq!(model.positions[..3], [Vec3::new(1.0, 1.0, 0.0), Vec3::Y, Vec3::new(1.0, 1.0, 0.0)]);
    let bare = json!({"componentType": 5126, "type": "VEC3", "count": 4, "sparse": sparse(1.into())});
    let model = gltf(&[("/accessors/0", bare)]);
    assert_eq!(model.positions, [Vec3::ZERO, Vec3::new(1.0, 1.0, 0.0), Vec3::Y, Vec3::ZERO]);
    refused(&[("/accessors/0/sparse", sparse(2.into()))], &["accessor 0:", "sparse element 0 does not ascend"]);
    refused(&[("/accessors/0/sparse", sparse(5.into()))], &["accessor 0:", "beyond the 6 bytes of buffer view 2"]);
}
