//! Files that are rejected, each with the faulty part.

use serde_json::{Value, json};

use super::super::{assert_refused, load_files};
use super::{binary, changed, data, document, gltf, loaded, refused};
use crate::plural::plural;

#[test]
fn files_that_show_nothing_are_refused_with_a_reason() {
    let shown = |nodes, meshes, surfaces, others| {
        let shown = format!(
            "{} without triangles, and {} of points or lines or without positions",
            plural(surfaces, "triangle primitive"),
            plural(others, "primitive")
        );
        format!("it has no visible triangles: it shows {shown}; the file has {nodes} nodes and {meshes} meshes")
    };
    let plain = |changes: &[(&str, Value)], shown: String| refused(changes, &[&shown]);
    plain(&[("/scenes/0/nodes", json!([]))], shown(1, 1, 0, 0));
    plain(&[("/nodes/0", json!({"name": "empty"}))], shown(1, 1, 0, 0));
    plain(&[("/meshes", json!([])), ("/nodes", json!([{}]))], shown(1, 0, 0, 0));
    plain(&[("/meshes/0/primitives", json!([]))], shown(1, 1, 0, 0));
    plain(
        &[
            ("/meshes/0/primitives/0/indices", json!(null)),
            ("/accessors/0/count", json!(0)),
            ("/accessors/1/count", json!(0)),
        ],
        shown(1, 1, 1, 0),
    );
    let mut all = document();
    for key in ["scene", "scenes", "nodes"] {
        all.as_object_mut().unwrap().remove(key);
    }
    let assert_why = |all: &Value, why: &str| {
        let message = loaded(all.to_string().as_bytes()).unwrap_err().to_string();
        assert!(message.ends_with(why), "{message}");
    };
    assert_why(&all, &shown(0, 1, 0, 0));
    all["nodes"] = json!([{}]);
    all["scenes"] = json!([{"name": "empty"}]);
    all["scene"] = json!(0);
    assert_why(&all, &shown(1, 1, 0, 0));
    all["nodes"] = json!([{"mesh": 0}]);
    all["scenes"] = json!([{"nodes": [0]}, {"name": "empty"}]);
    let whole = loaded(all.to_string().as_bytes()).unwrap();
    assert!(!whole.triangles.is_empty(), "a second scene may be empty");
}

#[test]
fn an_unsupported_version_is_reported_before_its_syntax() {
    for (asset, words) in [
        (json!({"version": "1.0"}), "it is glTF `1.0`: convert it"),
        (json!({"version": "3.0"}), "it is glTF `3.0`"),
        (json!({"version": "2.1", "minVersion": "2.1"}), "it needs glTF `2.1`"),
    ] {
        let text = json!({"asset": asset, "meshes": {"a": {}}}).to_string();
        assert_refused("a.gltf", text.as_bytes(), &["asset", words]);
    }
    // A list for an object, and nodes that are no list.
    for (text, words) in [
        (r#"[{"version": "2.0"}]"#, ["it is not a glTF 2.0 file", "not a JSON object"]),
        (r#"{"asset": {"version": "2.0"}, "nodes": {}}"#, ["it is not a glTF 2.0 file", "invalid type: map"]),
        (r#"{"asset": {"version": "1.0"}, "nodes": {}}"#, ["asset", "it is glTF `1.0`"]),
        (r#"{"asset": {"version": "2.0"}, "nodes": [{"mesh": 1e999}]}"#, ["nodes[0]:", "number out of range"]),
    ] {
        assert_refused("a.gltf", text.as_bytes(), &words);
    }
    let mut later = document();
    later["asset"] = json!({"version": "2.1", "minVersion": "2.0"});
    assert!(loaded(later.to_string().as_bytes()).is_ok());
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
        super::super::load(&inner.join("a.gltf"))
    };
    for uri in ["a.bin", "./a.bin", "deep/a.bin", "deep/../a.bin", "deep%2Fa.bin"] {
        assert!(load(uri).is_ok(), "{uri}");
    }
    let absolute = folder.path().join("a.bin");
    for uri in ["../a.bin", "deep/../../a.bin", "%2e%2e/a.bin", "..%2Fa.bin", absolute.to_str().unwrap()] {
        let message = load(uri).unwrap_err().to_string();
        assert!(message.contains("buffer 0: its file") && message.contains("outside the folder"), "{uri}: {message}");
    }
    let file = format!("file://{}", absolute.display());
    assert!(load(&file).unwrap_err().to_string().contains("not a relative path"));
}

#[test]
fn node_graphs_that_are_no_forest_are_refused() {
    let nodes = |nodes: Value, words: &[&str]| refused(&[("/nodes", nodes)], words);
    nodes(json!([{"mesh": 0}, {"children": [0]}, {"children": [0]}]), &["node 0:", "node 1 and of node 2"]);
    nodes(json!([{"mesh": 0}, {"children": [2]}, {"children": [1]}]), &["node 1:", "own ancestor"]);
    nodes(json!([{"mesh": 0, "children": [0]}]), &["node 0:", "own ancestor"]);
    nodes(json!([{"mesh": 0}, {"children": [9]}]), &["nodes[1].children[0]", "out of bounds"]);
    refused(&[("/scenes/0/nodes", json!([0, 0]))], &["node 0:", "twice"]);
    let child = [("/nodes", json!([{"children": [1]}, {"mesh": 0}])), ("/scenes/0/nodes", json!([1]))];
    refused(&child, &["scenes[0].nodes[0]", "node 1 is a child of another node"]);
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
            ["extensionsRequired: the file requires `KHR_draco_mesh_compression`", "`gltf-transform cp IN OUT`"],
        ),
        (
            "/meshes/0/primitives/0/attributes/POSITION",
            json!(77),
            ["meshes[0].primitives[0].attributes:", "index 77 is out of bounds"],
        ),
        (
            "/meshes/0/primitives/0/attributes/NORMAL",
            json!(77),
            ["meshes[0].primitives[0].attributes:", "index 77 is out of bounds"],
        ),
        (
            "/meshes/0/primitives/0/attributes",
            json!({"POSITION": 3}),
            ["accessor 3: it must be Vec3", "not Scalar of U16"],
        ),
        (
            "/meshes/0/primitives/0",
            json!({"attributes": {"POSITION": 0}, "indices": 0, "mode": 5}),
            ["accessor 0: it must be Scalar of unsigned", "not Vec3 of F32"],
        ),
        ("/meshes/0/primitives/0/material", json!(9), ["meshes[0].primitives[0].material:", "index out of bounds"]),
        ("/meshes/0/primitives/0/material", json!(u64::MAX), ["primitives[0].material:", "index out of bounds"]),
        ("/meshes/0/primitives/0/mode", json!(9), ["meshes[0].primitives[0].mode:", "invalid value"]),
        ("/accessors/0/count", json!(5), ["accessor 0:", "5 elements reach beyond the 48 bytes"]),
        ("/accessors/0/count", json!(u64::MAX), ["accessor 0:", "reach beyond"]),
        ("/accessors/0/count", json!(2), ["mesh 0, primitive 0:", "its NORMAL has 4 elements for 2 vertices"]),
        ("/accessors/0/count", json!(0), ["mesh 0, primitive 0:", "its NORMAL has 4 elements for 0 vertices"]),
        ("/accessors/0/byteOffset", json!(u64::MAX), ["accessor 0:", "reach beyond"]),
        ("/accessors/3/count", json!(5), ["mesh 0, primitive 0:", "5 corners"]),
        ("/bufferViews/0/byteLength", json!(1000), ["accessor 0:", "buffer view 0 reaches beyond"]),
        ("/bufferViews/0/byteOffset", json!(u64::MAX), ["accessor 0:", "buffer view 0 reaches beyond"]),
        ("/bufferViews/0/byteStride", json!(8), ["accessor 0:", "overlap"]),
        ("/bufferViews/0/buffer", json!(5), ["bufferViews[0].buffer:", "index out of bounds"]),
        ("/bufferViews/3/byteOffset", json!(48), ["primitive 0:", "names vertex"]),
        ("/buffers/0/byteLength", json!(1000), ["buffer 0:", "should have 1000 bytes but has 140"]),
        ("/buffers/0/uri", json!(""), ["buffer 0:", "its file `` cannot be read (it is not a regular file)"]),
        ("/buffers/0/uri", json!("b.bin"), ["buffer 0:", "`b.bin` cannot be read"]),
        ("/buffers/0/uri", json!("%FF"), ["buffer 0:", "its file `\u{fffd}` cannot be read"]),
        ("/buffers/0/uri", json!("https://example.org/a.bin"), ["buffer 0:", "not a relative path"]),
        ("/buffers/0/uri", json!("data:text/plain,abc"), ["buffer 0:", "not base64"]),
        ("/buffers/0/uri", json!("data:;base64,%%%"), ["buffer 0:", "cannot be read: Invalid byte 37, offset 0."]),
        ("/buffers/0/uri", json!("."), ["buffer 0:", "its file `.` cannot be read (it is not a regular file)"]),
        (
            "/nodes",
            json!([{"scale": [1e30, 1, 1], "children": [1]}, {"mesh": 0, "scale": [1e30, 1, 1]}]),
            ["node 1: it places vertex 1 of mesh 0", "not finite"],
        ),
        ("/nodes/0/mesh", json!(1_u64 << 32), ["nodes[0].mesh:", "index out of bounds"]),
        ("/scenes/0/nodes/0", json!(1_u64 << 32), ["scenes[0].nodes[0]:", "index out of bounds"]),
        ("/meshes/0/primitives/0/attributes/POSITION", json!(1_u64 << 32), ["attributes:", "is out of bounds"]),
        ("/meshes/0/primitives/0/mode", json!((1_u64 << 32) + 4), ["primitives[0].mode:", "invalid value"]),
        ("/accessors/0/componentType", json!((1_u64 << 32) + 5126), ["componentType:", "invalid value"]),
        ("/accessors/0/componentType", json!(5125), ["accessor 0: it must be Vec3", "not Vec3 of U32"]),
        ("/accessors/0/componentType", json!(5124), ["accessors[0].componentType:", "invalid value"]),
        ("/accessors/0/type", json!("VEC2"), ["accessor 0: it must be Vec3", "not Vec2 of F32"]),
        ("/accessors/0/type", json!("VEC5"), ["accessors[0].type:", "invalid value"]),
        ("/accessors/0/count", json!((1_u64 << 62) + 1), ["accessor 0:", "reach beyond"]),
        ("/accessors/0/count", json!("4"), ["accessors[0].count:", "invalid type"]),
        ("/accessors/3/componentType", json!(5126), ["accessor 3:", "reach beyond the 12 bytes"]),
        ("/accessors/3/componentType", json!(5122), ["accessor 3: it must be Scalar of unsigned", "not Scalar of I16"]),
        ("/materials", json!([[]]), ["materials:", "unexpected list"]),
        ("/meshes", json!({"a": {}}), ["meshes:", "invalid type: map"]),
        ("/nodes/0/rotation", json!([1, 2]), ["nodes[0].rotation", "invalid length 2"]),
        ("/asset", json!([]), ["it is not a glTF 2.0 file:", "no `asset` with a version"]),
        ("/scene", json!(3), ["scene:", "index out of bounds"]),
    ];
    for (pointer, value, words) in cases {
        refused(&[(pointer, value.clone())], words);
    }
    let float = [("/accessors/4/componentType", json!(5126)), ("/meshes/0/primitives/0/indices", json!(4))];
    refused(&float, &["accessor 4: it must be Scalar of unsigned", "not Scalar of F32"]);
    for (key, value, words) in [
        ("count", json!(0), "0 of its 4 elements are sparse"),
        ("count", json!(5), "5 of its 4 elements are sparse"),
        ("indices", json!({"bufferView": 2, "byteOffset": u64::MAX, "componentType": 5121}), "reach beyond"),
        ("values", json!({"bufferView": 0, "byteOffset": u64::MAX}), "reach beyond"),
        ("values", json!({"bufferView": 9}), "index out of bounds"),
        ("indices", json!({"bufferView": 2, "componentType": 5126}), "invalid value"),
    ] {
        let indices = json!({"bufferView": 2, "componentType": 5121});
        let mut sparse = json!({"count": 1, "indices": indices, "values": {"bufferView": 0}});
        sparse[key] = value;
        refused(&[("/accessors/0/sparse", sparse)], &["accessor", words]);
    }
    let zeros = json!({"componentType": 5126, "type": "VEC3", "count": 4_000_000_000_u64, "sparse": {"count": 1, "indices": {"bufferView": 2, "componentType": 5121}, "values": {"bufferView": 0}}});
    let bare = ("/meshes/0/primitives/0/attributes", json!({"POSITION": 0}));
    refused(&[("/accessors/0", zeros), bare], &["4000000000 vertices", "the limit for files of"]);
}

/// Nine million bytes of nodes would take more than half a gigabyte of memory.
#[test]
fn a_document_of_too_many_objects_is_refused_before_it_is_parsed() {
    let text = format!("{{\"asset\":{{\"version\":\"2.0\"}},\"nodes\":[{}{{}}]}}", "{},".repeat(3_000_000));
    assert_refused("a.gltf", text.as_bytes(), &["its text describes 3000003 objects", "split the file"]);
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
    assert!(error.to_string().contains("for files of"), "{error}");
}

/// It does not make the scene larger, but all of it would be visited.
#[test]
fn many_empty_primitives_shown_often_are_refused() {
    let mut document = document();
    let empty = json!({"attributes": {"POSITION": 0}, "indices": 5});
    document["accessors"].as_array_mut().unwrap().push(json!({"componentType": 5121, "type": "SCALAR", "count": 0}));
    let primitives = document["meshes"][0]["primitives"].as_array_mut().unwrap();
    primitives.extend(std::iter::repeat_n(empty, 20_000));
    document["nodes"] = (0..20_000).map(|_| json!({"mesh": 0})).collect();
    document["scenes"][0]["nodes"] = (0..20_000).collect();
    let error = loaded(document.to_string().as_bytes()).unwrap_err().to_string();
    assert!(
        error.contains("its nodes instantiate 40000 triangles") && error.contains("the limit for files of"),
        "{error}"
    );
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
    assert_refused("a.glb", &with(8, 3), &["its first chunk is not a complete JSON chunk"]);
    assert_refused("a.glb", &with(8, u32::MAX), &["truncated"]);
    assert_refused("a.glb", &with(12, u32::MAX), &["not a glTF 2.0 file"]);
    let mut longer = file.clone();
    longer.extend([1, 2, 3]);
    assert_eq!(load_files(&[("a.glb", &longer)]).unwrap(), gltf(&[]));
}
