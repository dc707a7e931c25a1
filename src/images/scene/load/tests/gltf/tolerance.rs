//! Valid files that the crate alone would refuse, and faults in parts that are not read.

use serde_json::{Value, json};

use super::super::load_files;
use super::{binary, changed, data, gltf, loaded, refused};

#[test]
fn what_is_not_read_is_no_reason_to_refuse() {
    for (pointer, value) in [
        ("/extras", json!("text")),
        ("/nodes/0/extras", json!([{"mesh": 1_u64 << 40}, [[]]])),
        ("/accessors/0/min", json!("least")),
        ("/accessors/0/max", json!(null)),
        ("/bufferViews/2/byteStride", json!(1)),
        ("/bufferViews/2/target", json!(7)),
        ("attributes/_FOO", json!(99)),
        ("attributes/COLOR_RED", json!(0)),
        ("attributes/JOINTS_\n", json!("x")),
        ("/meshes/0/weights", json!({})),
        ("/accessors/-", json!({"componentType": 5126, "type": "VEC3", "count": 4})),
        ("/animations", json!([{"channels": 3}])),
        ("/cameras", json!([{"type": "perspective"}])),
        ("/nodes/0/camera", json!(12)),
        ("/samplers", json!([{"magFilter": 1}])),
        ("/textures", json!([{"extensions": {"EXT_texture_webp": {"source": 0}}}])),
        ("/materials", json!([{"alphaMode": "SOLID", "emissiveFactor": 1, "doubleSided": "no"}])),
        ("/scenes/-", json!({"name": "no nodes"})),
        ("/asset/extras", json!({"version": []})),
    ] {
        assert_eq!(gltf(&[(pointer, value)]).triangles.len(), 2, "{pointer}");
    }
    let mut document: Value = serde_json::from_slice(&changed(&[])).unwrap();
    for accessor in document["accessors"].as_array_mut().unwrap() {
        accessor.as_object_mut().unwrap().retain(|key, _| key != "min" && key != "max");
    }
    assert_eq!(loaded(document.to_string().as_bytes()).unwrap(), gltf(&[]));
}

/// A second mesh that no node shows, with an accessor in a buffer view and a buffer of its own, all of them broken.
#[test]
fn parts_to_which_nothing_shown_refers_may_be_broken() {
    let unread = [
        ("/meshes/-", json!({"primitives": [{"attributes": {"POSITION": 5}, "mode": 77}]})),
        ("/accessors/-", json!({"bufferView": 5, "componentType": 5126, "type": "VEC3", "count": 1 << 30})),
        ("/bufferViews/-", json!({"buffer": 1, "byteLength": 9})),
        ("/buffers/-", json!({"uri": "missing.bin", "byteLength": 9})),
    ];
    assert_eq!(gltf(&unread), gltf(&[]));
    let texture = [("attributes/TEXCOORD_0", json!(5))];
    let accessor = |broken: Value| [("/accessors/-", broken)];
    for broken in [
        json!({"bufferView": 77, "componentType": 5126, "type": "VEC2", "count": 4}),
        json!({"bufferView": 1_u64 << 32, "componentType": 5126, "type": "VEC2", "count": 4}),
        json!({"bufferView": 0, "componentType": 5126, "type": "VEC2", "count": u64::MAX}),
        json!({"componentType": 9, "type": "VEC9", "count": -4, "sparse": []}),
        json!([]),
        json!(null),
    ] {
        assert_eq!(gltf(&[&accessor(broken.clone())[..], &texture].concat()), gltf(&[]), "{broken}");
    }
    // They are refused where something shown refers to them.
    let shown = [("/nodes/-", json!({"mesh": 1})), ("/scenes/0/nodes", json!([0, 1]))];
    refused(&[&unread[..], &shown].concat(), &["meshes[1].primitives[0].mode:", "invalid value"]);
    let mode = [("/meshes/1/primitives/0/mode", json!(4))];
    refused(&[&unread[..], &shown, &mode].concat(), &["buffer 1: its file `missing.bin` cannot be read"]);
    let view = [("/bufferViews/5/buffer", json!(0))];
    refused(&[&unread[..], &shown, &mode, &view].concat(), &["accessor 5:", "reach beyond the 9 bytes"]);
}

/// A node without extensions is read at once, any other node by way of a list of values.
#[test]
fn both_ways_to_read_a_node_agree() {
    for node in [
        json!({"mesh": 0, "translation": [0.1, 16777217, -0.0], "rotation": [0.6, 0, 0, 0.8], "scale": [1, 2, 3]}),
        json!({"mesh": 0, "matrix": [0.1, 0, 0, 0, 0, 1e-40, 0, 0, 0, 0, 0.7, 0, 1e30, 0.3, 0.123456789123, 1]}),
        json!({"mesh": 0, "name": "node", "children": null, "matrix": null, "extras": [1], "camera": 9}),
    ] {
        let mut extended = node.clone();
        extended["extensions"] = json!({});
        assert_eq!(gltf(&[("/nodes/0", node)]), gltf(&[("/nodes/0", extended)]));
    }
}

#[test]
fn marks_and_chunks_around_the_document_are_skipped() {
    let marked = [b"\xef\xbb\xbf", &changed(&[])[..]].concat();
    assert_eq!(loaded(&marked).unwrap(), gltf(&[]));
    let mut file = binary();
    let chunk = |kind: &[u8; 4]| [&4_u32.to_le_bytes()[..], kind, b"data"].concat();
    file.extend(chunk(b"MINE"));
    let length = file.len() as u32;
    file[8..12].copy_from_slice(&length.to_le_bytes());
    file.extend(b"behind the end");
    assert_eq!(load_files(&[("a.glb", &file)]).unwrap(), gltf(&[]));

    // Without a binary chunk, in whose place stands another one.
    let json = changed(&[]);
    let mut file = b"glTF\x02\0\0\0".to_vec();
    file.extend((12 + 8 + json.len() as u32 + 12).to_le_bytes());
    file.extend([&(json.len() as u32).to_le_bytes()[..], b"JSON", &json, &chunk(b"MINE")].concat());
    assert_eq!(load_files(&[("a.glb", &file), ("a.bin", &data())]).unwrap(), gltf(&[]));
}
