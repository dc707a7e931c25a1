//! Files that are rejected, each with the faulty part.

use serde_json::{Value, json};

use super::super::{assert_refused, load_files};
use super::{binary, changed, data, document, gltf, loaded, refused};

#[test]
fn files_that_show_nothing_are_refused_with_a_reason() {
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
fn an_unsupported_version_is_reported_before_its_syntax() {
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
        assert!(message.contains("buffer 0: its file") && message.contains("not below the folder"), "{uri}: {message}");
    }
    let file = format!("file://{}", absolute.display());
    assert!(load(&file).unwrap_err().to_string().contains("no relative path"));
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
