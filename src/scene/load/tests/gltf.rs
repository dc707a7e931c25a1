use glam::Vec3;
use serde_json::{Value, json};

use super::{LoadError, assert_refused, corners, face_normals, load_files};
use crate::scene::Model;

/// Four corners of a unit square in the plane z = 0, their normals, and the indices of its two triangles as u8, u16,
/// u32.
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

/// The square at one node, its data in `a.bin`.
fn document() -> Value {
    let accessor = |view, component, kind, count| json!({"bufferView": view, "componentType": component, "type": kind, "count": count, "min": [0, 0, 0], "max": [1, 1, 0]});
    json!({
        "asset": {"version": "2.0"},
        "buffers": [{"uri": "a.bin", "byteLength": 140}],
        "bufferViews": [
            {"buffer": 0, "byteLength": 48},
            {"buffer": 0, "byteOffset": 48, "byteLength": 48},
            {"buffer": 0, "byteOffset": 96, "byteLength": 6},
            {"buffer": 0, "byteOffset": 104, "byteLength": 12},
            {"buffer": 0, "byteOffset": 116, "byteLength": 24}
        ],
        "accessors": [
            accessor(0, 5126, "VEC3", 4),
            accessor(1, 5126, "VEC3", 4),
            accessor(2, 5121, "SCALAR", 6),
            accessor(3, 5123, "SCALAR", 6),
            accessor(4, 5125, "SCALAR", 6)
        ],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "NORMAL": 1}, "indices": 3}]}],
        "nodes": [{"mesh": 0}],
        "scenes": [{"nodes": [0]}],
        "scene": 0
    })
}

fn changed(changes: &[(&str, Value)]) -> Vec<u8> {
    let mut document = document();
    for (pointer, value) in changes {
        let (parent, key) = pointer.rsplit_once('/').unwrap();
        match document.pointer_mut(parent).unwrap() {
            Value::Array(list) if key == "-" => list.push(value.clone()),
            Value::Array(list) => list[key.parse::<usize>().unwrap()] = value.clone(),
            parent => parent[key] = value.clone(),
        }
    }
    document.to_string().into_bytes()
}

/// A document, with its data beside it.
fn loaded(document: &[u8]) -> Result<Model, LoadError> {
    load_files(&[("a.gltf", document), ("a.bin", &data())])
}

fn gltf(changes: &[(&str, Value)]) -> Model {
    loaded(&changed(changes)).unwrap()
}

fn refused(changes: &[(&str, Value)], words: &[&str]) {
    let error = loaded(&changed(changes)).expect_err(words[0]);
    let message = error.to_string();
    assert!(!message.contains('\n') && message.contains("a.gltf"), "{message:?}");
    words.iter().for_each(|word| assert!(message.contains(word), "{message:?} does not contain {word:?}"));
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

pub(super) fn text() -> Vec<u8> {
    let uri = format!("data:application/octet-stream;base64,{}", base64::encode(data()));
    changed(&[("/buffers/0/uri", uri.into())])
}

#[test]
fn buffers_lie_apart_or_within() {
    let model = gltf(&[]);
    assert_eq!(model.triangles, [[0, 1, 2], [0, 2, 3]]);
    assert_eq!(model.positions, [Vec3::ZERO, Vec3::X, Vec3::new(1.0, 1.0, 0.0), Vec3::Y]);
    assert_eq!((&model.normals[..], &model.normal_indices), (&[Vec3::Z; 4][..], &model.triangles));
    assert_eq!((model.materials.len(), model.material_of.len(), model.notes.len()), (1, 0, 0));
    assert_eq!(load_files(&[("a.glb", &binary())]).unwrap(), model);
    assert_eq!(load_files(&[("a.gltf", &text())]).unwrap(), model);
    let escaped = changed(&[("/buffers/0/uri", "a%20b.bin".into())]);
    assert_eq!(load_files(&[("a.gltf", &escaped), ("a b.bin", &data())]).unwrap(), model);
}

#[test]
fn indices_of_all_widths_and_none() {
    for accessor in [2, 4] {
        assert_eq!(gltf(&[("/meshes/0/primitives/0/indices", accessor.into())]), gltf(&[]));
    }
    let three = [("/accessors/0/count", json!(3)), ("/accessors/1/count", json!(3))];
    let primitive = json!({"attributes": {"POSITION": 0}});
    let model = gltf(&[&three[..], &[("/meshes/0/primitives/0", primitive)]].concat());
    assert_eq!((model.triangles, model.normals.len()), (vec![[0, 1, 2]], 0));
}

#[test]
fn strips_and_fans_and_what_is_no_triangle() {
    let mode = |mode: u32| {
        gltf(&[("/meshes/0/primitives/0", json!({"attributes": {"POSITION": 0, "_OWN": 1}, "mode": mode}))])
    };
    assert_eq!(mode(5).triangles, [[0, 1, 2], [1, 3, 2]]);
    assert_eq!(mode(6).triangles, [[0, 1, 2], [0, 2, 3]]);
    let primitive = |mode: u32| json!({"attributes": {"POSITION": 0}, "mode": mode});
    for lines in 0..4 {
        refused(&[("/meshes/0/primitives/0", primitive(lines))], &["no triangles", "only points, lines"]);
        let both = gltf(&[("/meshes/0/primitives/-", primitive(lines))]);
        assert!(both.triangles.len() == 2 && both.notes[0].starts_with("1 primitive is points"), "{:?}", both.notes);
    }
}

#[test]
fn what_shows_nothing_says_why() {
    let plain = |changes: &[(&str, Value)], word: &str| refused(changes, &["no triangles", word]);
    plain(&[("/scenes/0/nodes", json!([]))], "scene 0, its default, has no nodes");
    plain(&[("/nodes/0", json!({"name": "empty"}))], "no node of scene 0, its default, has a mesh");
    plain(&[("/meshes", json!([])), ("/nodes", json!([{}]))], "it has no meshes");
    plain(
        &[
            ("/meshes/0/primitives/0/indices", json!(null)),
            ("/accessors/0/count", json!(0)),
            ("/accessors/1/count", json!(0)),
        ],
        "too few corners for a triangle",
    );
    let mut all = document();
    for key in ["scene", "scenes", "nodes"] {
        all.as_object_mut().unwrap().remove(key);
    }
    let assert_why = |all: &Value, why: &str| {
        let message = loaded(all.to_string().as_bytes()).unwrap_err().to_string();
        assert!(message.ends_with(why), "{message}");
    };
    assert_why(&all, "it has no nodes, which would show its meshes, 1");
    all["nodes"] = json!([{}]);
    assert_why(&all, "no node has a mesh");
    all["scenes"] = json!([{"name": "empty"}]);
    all["scene"] = json!(0);
    assert_why(&all, "scene 0, its default, has no nodes");
    all["nodes"] = json!([{"mesh": 0}]);
    all["scenes"] = json!([{"nodes": [0]}, {"name": "empty"}]);
    let whole = loaded(all.to_string().as_bytes()).unwrap();
    assert!(!whole.triangles.is_empty(), "a second scene may be empty");
    all["meshes"][0]["primitives"] = json!([]);
    assert_why(&all, "its meshes have no primitives");
}

#[test]
fn other_versions_are_told_before_their_forms() {
    for (asset, words) in [
        (json!({"version": "1.0"}), "it is glTF `1.0`: convert it"),
        (json!({"version": "3.0"}), "it is glTF `3.0`"),
        (json!({"version": "2.1", "minVersion": "2.1"}), "it needs glTF `2.1`"),
    ] {
        let text = json!({"asset": asset, "meshes": {"a": {}}}).to_string();
        assert_refused("a.gltf", text.as_bytes(), &["asset", words]);
    }
    let mut later = document();
    later["asset"] = json!({"version": "2.1", "minVersion": "2.0"});
    assert!(loaded(later.to_string().as_bytes()).is_ok());
}

#[test]
fn textures_and_morph_targets_are_told() {
    let materials = json!([
        {"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}},
        {"normalTexture": {"index": 0}}
    ]);
    let changes = [
        ("/materials", materials),
        ("/textures", json!([{"source": 0}])),
        ("/images", json!([{"uri": "a.png"}])),
        ("/meshes/0/primitives/0/material", json!(1)),
        ("/meshes/0/primitives/0/targets", json!([{"POSITION": 0}])),
    ];
    let notes = gltf(&changes).notes;
    assert!(
        notes[0].starts_with("1 material has a texture") && notes[1].starts_with("1 primitive has morph"),
        "{notes:?}"
    );
}

#[test]
fn files_lie_below_the_folder() {
    let folder = tempfile::tempdir().unwrap();
    let inner = folder.path().join("inner");
    std::fs::create_dir_all(inner.join("deep")).unwrap();
    for place in [folder.path(), &inner, &inner.join("deep")] {
        std::fs::write(place.join("a.bin"), data()).unwrap();
    }
    let load = |uri: &str| {
        std::fs::write(inner.join("a.gltf"), changed(&[("/buffers/0/uri", uri.into())])).unwrap();
        super::load(&inner.join("a.gltf"))
    };
    for uri in ["a.bin", "./a.bin", "deep/a.bin", "deep/../a.bin", "deep%2Fa.bin"] {
        assert!(load(uri).is_ok(), "{uri}");
    }
    let absolute = folder.path().join("a.bin");
    for uri in ["../a.bin", "deep/../../a.bin", "%2e%2e/a.bin", "..%2Fa.bin", absolute.to_str().unwrap()] {
        let message = load(uri).unwrap_err().to_string();
        assert!(message.contains("buffer 0: its file") && message.contains("not below the folder"), "{uri}: {message}");
    }
    let file = format!("file://{}", absolute.display());
    assert!(load(&file).unwrap_err().to_string().contains("no relative path"));
}

#[test]
fn transforms_accumulate_and_mirrors_turn_the_winding() {
    // Half a turn about z after a shift, times a mirror with a scale: (x, y, z) -> (1 + 2x, -y, 3z).
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
    // Tilt the square to the plane z = x, then stretch it along x: its normal (-1, 0, 1) becomes (-1, 0, 4).
    let tilt = json!({"mesh": 0, "matrix": [1, 0, 1, 0, 0, 1, 0, 0, -1, 0, 1, 0, 0, 0, 0, 1]});
    let stretch = json!({"children": [0], "scale": [4, 1, 1]});
    for mirror in [1.0, -1.0] {
        let top = json!({"children": [1], "scale": [1, mirror, 1]});
        let changes = [
            ("/nodes/0", tilt.clone()),
            ("/nodes/-", stretch.clone()),
            ("/nodes/-", top),
            ("/scenes/0/nodes", json!([2])),
        ];
        let model = gltf(&changes);
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
    // Indices 0 and 1 take the third and fourth corner.
    let model = gltf(&[("/accessors/0/sparse", sparse(0.into()))]);
    assert_eq!(model.positions[..3], [Vec3::new(1.0, 1.0, 0.0), Vec3::Y, Vec3::new(1.0, 1.0, 0.0)]);
    let bare = json!({"componentType": 5126, "type": "VEC3", "count": 4, "sparse": sparse(1.into())});
    let model = gltf(&[("/accessors/0", bare)]);
    assert_eq!(model.positions, [Vec3::ZERO, Vec3::new(1.0, 1.0, 0.0), Vec3::Y, Vec3::ZERO]);
    refused(&[("/accessors/0/sparse", sparse(2.into()))], &["accessor 0:", "sparse element 0 does not ascend"]);
    refused(&[("/accessors/0/sparse", sparse(5.into()))], &["accessor 0:", "beyond the 6 bytes of buffer view 2"]);
}

#[test]
fn node_graphs_that_are_no_forest_are_refused() {
    let nodes = |nodes: Value, words: &[&str]| refused(&[("/nodes", nodes)], words);
    nodes(json!([{"mesh": 0}, {"children": [0]}, {"children": [0]}]), &["node 0:", "node 1 and of node 2"]);
    nodes(json!([{"mesh": 0}, {"children": [2]}, {"children": [1]}]), &["node 1:", "own ancestor"]);
    nodes(json!([{"mesh": 0, "children": [0]}]), &["node 0:", "own ancestor"]);
    nodes(json!([{"mesh": 0}, {"children": [9]}]), &["nodes[1]", "out of bounds"]);
    refused(&[("/scenes/0/nodes", json!([0, 0]))], &["node 0:", "twice"]);
    let child = [("/nodes", json!([{"children": [1]}, {"mesh": 0}])), ("/scenes/0/nodes", json!([1]))];
    refused(&child, &["scenes[0].nodes[0]", "node 1 is a child of another one"]);
    let chain = |length: usize| (1..length).map(|child| json!({"children": [child]})).chain([json!({"mesh": 0})]);
    assert_eq!(gltf(&[("/nodes", chain(1024).collect())]).triangles.len(), 2);
    nodes(chain(1025).collect(), &["node 1024:", "deeper than 1024"]);
    nodes(chain(100_000).collect(), &["deeper than 1024"]);
}

#[test]
fn malformed_files_are_refused_with_their_part() {
    let cases: &[(&str, Value, [&str; 2])] = &[
        (
            "/extensionsRequired",
            json!(["KHR_draco_mesh_compression"]),
            ["requires `KHR_draco_mesh_compression`", "export"],
        ),
        (
            "/meshes/0/primitives/0/attributes/POSITION",
            json!(77),
            ["meshes[0].primitives[0].attributes.POSITION:", "index 77 is out of bounds"],
        ),
        (
            "/meshes/0/primitives/0/attributes/NORMAL",
            json!(77),
            ["meshes[0].primitives[0].attributes.NORMAL:", "index 77 is out of bounds"],
        ),
        ("/meshes/0/primitives/0/attributes/POSITION", json!(3), ["accessor 3:", "VEC3 of f32"]),
        ("/meshes/0/primitives/0/indices", json!(0), ["accessor 0:", "SCALAR and unsigned"]),
        ("/meshes/0/primitives/0/material", json!(9), ["meshes[0].primitives[0].material:", "index 9 is out of"]),
        ("/meshes/0/primitives/0/material", json!(u64::MAX), ["primitives[0].material:", "is out of bounds"]),
        ("/meshes/0/primitives/0/mode", json!(9), ["meshes[0]", "invalid"]),
        ("/accessors/0/count", json!(5), ["accessor 0:", "5 elements reach beyond the 48 bytes"]),
        ("/accessors/0/count", json!(u64::MAX), ["accessor 0:", "reach beyond"]),
        ("/accessors/0/count", json!(2), ["mesh 0, primitive 0:", "4 normals for 2 vertices"]),
        ("/accessors/0/count", json!(0), ["mesh 0, primitive 0:", "4 normals for 0 vertices"]),
        ("/accessors/0/byteOffset", json!(u64::MAX), ["accessor 0:", "reach beyond"]),
        ("/accessors/3/count", json!(5), ["mesh 0, primitive 0:", "5 corners"]),
        ("/bufferViews/0/byteLength", json!(1000), ["accessor 0:", "buffer view 0 reaches beyond"]),
        ("/bufferViews/0/byteOffset", json!(u64::MAX), ["accessor 0:", "buffer view 0 reaches beyond"]),
        ("/bufferViews/0/byteStride", json!(8), ["accessor 0:", "overlap"]),
        ("/bufferViews/0/buffer", json!(5), ["accessor 0:", "of buffer 5, there are 1"]),
        ("/bufferViews/3/byteOffset", json!(48), ["primitive 0:", "names vertex"]),
        ("/buffers/0/byteLength", json!(1000), ["buffer 0:", "should have 1000 bytes and has 140"]),
        ("/buffers/0/uri", json!(""), ["buffer 0:", "its URI is empty"]),
        ("/buffers/0/uri", json!("b.bin"), ["buffer 0:", "`b.bin` cannot be read"]),
        ("/buffers/0/uri", json!("%FF"), ["buffer 0:", "not in UTF-8"]),
        ("/buffers/0/uri", json!("https://example.org/a.bin"), ["buffer 0:", "no relative path"]),
        ("/buffers/0/uri", json!("data:text/plain,abc"), ["buffer 0:", "not in base64"]),
        ("/buffers/0/uri", json!("data:;base64,%%%"), ["buffer 0:", "cannot be read: Invalid byte 37, offset 0."]),
        ("/buffers/0/uri", json!("."), ["buffer 0:", "not a regular file"]),
        (
            "/nodes",
            json!([{"scale": [1e30, 1, 1], "children": [1]}, {"mesh": 0, "scale": [1e30, 1, 1]}]),
            ["node 1: it places vertex 1 of mesh 0", "not finite"],
        ),
        ("/nodes/0/mesh", json!(1_u64 << 32), ["nodes[0].mesh:", "index 4294967296 is out of bounds"]),
        ("/scenes/0/nodes/0", json!(1_u64 << 32), ["scenes[0].nodes[0]:", "index 4294967296 is out of bounds"]),
        ("/scene", json!(3), ["scene:", "it names scene 3, but the file has 1 scenes"]),
    ];
    for (pointer, value, words) in cases {
        refused(&[(pointer, value.clone())], words);
    }
    let zeros = json!({"componentType": 5126, "type": "VEC3", "count": 4_000_000_000_u64, "sparse": {"count": 1, "indices": {"bufferView": 2, "componentType": 5121}, "values": {"bufferView": 0}}});
    refused(&[("/accessors/0", zeros)], &["accessor 0:", "without data"]);
}

#[test]
fn a_mesh_shown_too_often_is_refused_before_it_is_expanded() {
    // 2^20 corners at 2^14 nodes.
    let mut document = document();
    let bytes = vec![0; 4 << 20];
    document["buffers"][0]["byteLength"] = bytes.len().into();
    document["bufferViews"] = json!([{"buffer": 0, "byteLength": bytes.len()}]);
    document["accessors"][0]["count"] = (bytes.len() / 12).into();
    document["accessors"][3] = json!({"bufferView": 0, "componentType": 5121, "type": "SCALAR", "count": 3 << 20});
    document["accessors"].as_array_mut().unwrap().truncate(4);
    document["accessors"].as_array_mut().unwrap().iter_mut().for_each(|a| a["bufferView"] = 0.into());
    document["meshes"] = json!([{"primitives": [{"attributes": {"POSITION": 0}, "indices": 3}]}]);
    document["nodes"] = (0..1 << 14).map(|_| json!({"mesh": 0})).collect();
    document["scenes"][0]["nodes"] = (0..1 << 14).collect();
    let error = load_files(&[("a.gltf", document.to_string().as_bytes()), ("a.bin", &bytes)]).unwrap_err();
    assert!(error.to_string().contains("17179869184 triangles"), "{error}");
    assert!(error.to_string().contains("from files of"), "{error}");
}

#[test]
fn malformed_binary_files_are_refused() {
    let file = binary();
    for end in 0..file.len() {
        assert_refused("a.glb", &file[..end], &["a.glb"]);
    }
    let with = |at: usize, word: u32| {
        let mut file = file.clone();
        file[at..at + 4].copy_from_slice(&word.to_le_bytes());
        file
    };
    assert_refused("a.glb", &with(4, 1), &["binary glTF 1"]);
    assert_refused("a.glb", &with(8, 3), &["a length of 3 bytes"]);
    assert_refused("a.glb", &with(8, u32::MAX), &["truncated"]);
    assert_refused("a.glb", &with(12, u32::MAX), &["no glTF 2.0 file"]);
    let mut longer = file.clone();
    longer.extend([1, 2, 3]);
    assert_eq!(load_files(&[("a.glb", &longer)]).unwrap(), gltf(&[]));
}
