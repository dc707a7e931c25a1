//! Tests that errors name the faulty part of an invalid glTF file.

use serde_json::{Value, json};

use super::super::{assert_error, assert_refused, load, load_files};
use super::{binary, changed, data, document, gltf, loaded, refused};
#[test]
fn files_that_show_nothing_are_refused_with_a_reason() {
    let mut all = document();
    for key in ["scene", "scenes", "nodes"] {
        all[key] = Value::Null;
    }
    let counts = [("indices", json!(null)), ("/accessors/0/count", json!(0)), ("/accessors/1/count", json!(0))];
    for file in [
        changed(&[("/scenes/0/nodes", json!([]))]),
        changed(&[("/scenes/0", json!({"name": "empty"}))]),
        changed(&[("/nodes/0", json!({"name": "empty"}))]),
        changed(&[("/meshes", json!([])), ("/nodes", json!([{}]))]),
        changed(&[("/meshes/0/primitives", json!([]))]),
        changed(&counts),
        all.to_string().into_bytes(),
    ] {
        assert_error(loaded(&file), "a.gltf", &["it has no visible triangles: its nodes show no triangle primitive"]);
    }
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
    for (text, words) in [
        (r#"[{"version": "2.0"}]"#, ["it is not a glTF 2.0 file", "not a JSON object"]),
        (r#"{"asset": {"version": "2.0"}, "nodes": {}}"#, ["it is not a glTF 2.0 file", "invalid type: map"]),
        (r#"{"asset": {"version": "1.0"}, "nodes": {}}"#, ["asset", "it is glTF `1.0`"]),
        (r#"{"asset": {"version": "2.0"}, "nodes": [{"mesh": 1e999}]}"#, ["nodes[0]:", "number out of range"]),
    ] {
        assert_refused("a.gltf", text.as_bytes(), &words);
    }
    gltf(&[("/asset", json!({"version": "2.1", "minVersion": "2.0"}))]);
}

#[test]
fn files_lie_below_the_folder() {
    let folder = tempfile::tempdir().unwrap();
    let inner = folder.path().join("inner");
    std::fs::create_dir_all(inner.join("deep")).unwrap();
    for place in [folder.path(), &inner, &inner.join("deep")] {
        std::fs::write(place.join("a.bin"), data()).unwrap();
    }
    let with = |uri: &str| {
        std::fs::write(inner.join("a.gltf"), changed(&[("/buffers/0/uri", uri.into())])).unwrap();
        load(&inner.join("a.gltf"))
    };
    for uri in ["a.bin", "./a.bin", "deep/a.bin", "deep/../a.bin", "deep%2Fa.bin"] {
        assert!(with(uri).is_ok(), "{uri}");
    }
    let absolute = folder.path().join("a.bin").display().to_string();
    for uri in ["../a.bin", "deep/../../a.bin", "%2e%2e/a.bin", "..%2Fa.bin", &absolute] {
        assert_error(with(uri), "a.gltf", &["buffer 0: its file", "outside the folder"]);
    }
    assert_error(with(&format!("file://{absolute}")), "a.gltf", &["not a relative path"]);
}

#[test]
fn node_graphs_that_are_no_forest_are_refused() {
    let nodes = |nodes: Value, words: &[&str]| refused(&[("/nodes", nodes)], words);
    nodes(json!([{"mesh": 0}, {"children": [0]}, {"children": [0]}]), &["node 0:", "node 1 and of node 2"]);
    nodes(json!([{"mesh": 0}, {"children": [2]}, {"children": [1]}]), &["node 1:", "own ancestor"]);
    nodes(json!([{"mesh": 0, "children": [0]}]), &["node 0:", "the scene lists it twice, or another node does"]);
    nodes(json!([{"mesh": 0}, {"children": [9]}]), &["nodes[1].children[0]", "out of bounds"]);
    refused(&[("/scenes/0/nodes", json!([0, 0]))], &["node 0:", "twice"]);
    let child = [("/nodes", json!([{"children": [1]}, {"mesh": 0}])), ("/scenes/0/nodes", json!([1]))];
    refused(&child, &["node 1:", "list only roots"]);
    let chain = |length: usize| (1..length).map(|child| json!({"children": [child]})).chain([json!({"mesh": 0})]);
    assert_eq!(gltf(&[("/nodes", chain(1024).collect())]).triangles.len(), 2);
    nodes(chain(1025).collect(), &["node 1024:", "deeper than 1024"]);
    nodes(chain(100_000).collect(), &["deeper than 1024"]);
}

#[test]
fn malformed_files_are_refused_with_their_part() {
    let cases: &[(&str, Value, [&str; 2])] = &[
        ("attributes/POSITION", json!(77), ["meshes[0].primitives[0].attributes:", "index 77 is out of bounds"]),
        ("attributes", json!({"POSITION": 3}), ["accessor 3: it must be Vec3", "not Scalar of U16"]),
        (
            "/meshes/0/primitives/0",
            json!({"attributes": {"POSITION": 0}, "indices": 0, "mode": 5}),
            ["accessor 0: it must be Scalar of unsigned", "not Vec3 of F32"],
        ),
        ("material", json!(9), ["meshes[0].primitives[0].material:", "index out of bounds"]),
        ("material", json!(u64::MAX), ["primitives[0].material:", "index out of bounds"]),
        ("mode", json!(9), ["meshes[0].primitives[0].mode:", "invalid value"]),
        ("/accessors/0/count", json!(5), ["accessor 0:", "5 elements reach beyond the 48 bytes"]),
        ("/accessors/0/count", json!(u64::MAX), ["accessor 0:", "reach beyond"]),
        ("/accessors/0/count", json!(2), ["mesh 0, primitive 0:", "its NORMAL has 4 elements for 2 vertices"]),
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
        (
            "/nodes",
            json!([{"scale": [1e30, 1, 1], "children": [1]}, {"mesh": 0, "scale": [1e30, 1, 1]}]),
            ["node 1: it places vertex 1 of mesh 0", "not finite"],
        ),
        ("/nodes/0/mesh", json!(1_u64 << 32), ["nodes[0].mesh:", "index out of bounds"]),
        ("/scenes/0/nodes/0", json!(1_u64 << 32), ["scenes[0].nodes[0]:", "index out of bounds"]),
        ("attributes/POSITION", json!(1_u64 << 32), ["attributes:", "is out of bounds"]),
        ("mode", json!((1_u64 << 32) + 4), ["primitives[0].mode:", "invalid value"]),
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
    let float = [("/accessors/4/componentType", json!(5126)), ("indices", json!(4))];
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
    let bare = ("attributes", json!({"POSITION": 0}));
    refused(&[("/accessors/0", zeros), bare], &["4000000000 vertices", "the limit for files of"]);
}

#[test]
fn meshes_shown_too_often_are_refused_before_they_are_expanded() {
    let shown = |times: u32, changes: &[(&'static str, Value)]| {
        let nodes =
            [("/nodes", (0..times).map(|_| json!({"mesh": 0})).collect()), ("/scenes/0/nodes", (0..times).collect())];
        changed(&[changes, &nodes].concat())
    };
    // 2^20 triangles at 2^14 nodes.
    let bytes = vec![0; 4 << 20];
    let file = shown(
        1 << 14,
        &[
            ("/buffers/0/byteLength", bytes.len().into()),
            ("/bufferViews/0/byteLength", bytes.len().into()),
            ("/accessors/0/count", (bytes.len() / 12).into()),
            ("/accessors/3", json!({"bufferView": 0, "componentType": 5121, "type": "SCALAR", "count": 3 << 20})),
            ("attributes", json!({"POSITION": 0})),
        ],
    );
    let result = load_files(&[("a.gltf", &file), ("a.bin", &bytes)]);
    assert_error(result, "a.gltf", &["17179869184 triangles", "for files of"]);

    // The limit also counts empty primitives, because reading them takes time.
    let mut primitives = vec![json!({"attributes": {"POSITION": 0}, "indices": 3})];
    primitives.resize(20_000, json!({"attributes": {"POSITION": 0}, "indices": 5}));
    let empty = json!({"componentType": 5121, "type": "SCALAR", "count": 0});
    let file = shown(20_000, &[("/accessors/-", empty), ("/meshes/0/primitives", primitives.into())]);
    let words = ["its nodes instantiate 40000 triangles", "the limit for files of"];
    assert_error(loaded(&file), "a.gltf", &words);
}

#[test]
fn malformed_binary_files_are_refused() {
    let file = binary();
    for end in 0..file.len() {
        assert_refused("a.glb", &file[..end], &["a.glb"]);
    }
    for (at, word, words) in [
        (4, 1_u32, "binary glTF 1"),
        (8, 3, "its first chunk is not a complete JSON chunk"),
        (8, u32::MAX, "truncated"),
        (12, u32::MAX, "not a glTF 2.0 file"),
    ] {
        let mut file = file.clone();
        file[at..at + 4].copy_from_slice(&word.to_le_bytes());
        assert_refused("a.glb", &file, &[words]);
    }
    assert_eq!(load_files(&[("a.glb", &[&file[..], &[1, 2, 3]].concat())]).unwrap(), gltf(&[]));
}
