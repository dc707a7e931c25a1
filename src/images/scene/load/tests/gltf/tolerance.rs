//! Tests that the loader accepts faults in the parts of a glTF file that it does not use.

use serde_json::{Value, json};

use super::super::load_files;
use super::{binary, changed, data, gltf, loaded};

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

    // Another chunk is in the place of the binary chunk.
    let json = changed(&[]);
    let mut file = b"glTF\x02\0\0\0".to_vec();
    file.extend((12 + 8 + json.len() as u32 + 12).to_le_bytes());
    file.extend([&(json.len() as u32).to_le_bytes()[..], b"JSON", &json, &chunk(b"MINE")].concat());
    assert_eq!(load_files(&[("a.glb", &file), ("a.bin", &data())]).unwrap(), gltf(&[]));
}
