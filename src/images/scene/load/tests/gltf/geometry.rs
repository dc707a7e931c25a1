//! Tests quantised positions, instances, skins and extensions of glTF.

use glam::{Quat, Vec3};
use serde_json::{Value, json};

use super::super::{face_normals, load_files};
use super::{changed, gltf, refused};
use crate::scene::Model;

/// The square with the integer coordinates 0 and `one`. The corners are `stride` bytes apart.
fn quantised(component: u32, one: [u8; 4], stride: usize, is_normalized: bool, is_sparse: bool) -> Model {
    let size = if component < 5122 { 1 } else { 2 };
    let mut bytes = vec![0; 4 * stride];
    for (element, corner) in bytes.chunks_mut(stride).zip([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]) {
        for (bytes, _) in element.chunks_mut(size).zip(corner).filter(|(_, c)| *c == 1) {
            bytes.copy_from_slice(&one[..size]);
        }
    }
    bytes.extend([0, 1, 2, 3]);
    let mut positions =
        json!({"bufferView": 0, "componentType": component, "type": "VEC3", "count": 4, "normalized": is_normalized});
    if is_sparse {
        positions.as_object_mut().unwrap().remove("bufferView");
        let indices = json!({"bufferView": 1, "componentType": 5121});
        positions["sparse"] = json!({"count": 4, "indices": indices, "values": {"bufferView": 0}});
    }
    let document = changed(&[
        ("/extensionsUsed", json!(["KHR_mesh_quantization"])),
        ("/extensionsRequired", json!(["KHR_mesh_quantization"])),
        ("/buffers/0/byteLength", bytes.len().into()),
        ("/bufferViews/0", json!({"buffer": 0, "byteLength": 4 * stride, "byteStride": stride})),
        ("/bufferViews/1", json!({"buffer": 0, "byteOffset": 4 * stride, "byteLength": 4})),
        ("/accessors", json!([positions])),
        ("/meshes/0/primitives/0", json!({"attributes": {"POSITION": 0}, "mode": 6})),
    ]);
    load_files(&[("a.gltf", &document), ("a.bin", &bytes)]).unwrap()
}

#[test]
fn positions_are_integers_of_every_kind() {
    for (component, one, plain, normalized) in [
        (5120, [0x81, 0, 0, 0], -127.0, -1.0),
        (5120, [0x80, 0, 0, 0], -128.0, -1.0),
        (5120, [3, 0, 0, 0], 3.0, 3.0 / 127.0),
        (5121, [0xff, 0, 0, 0], 255.0, 1.0),
        (5121, [3, 0, 0, 0], 3.0, 3.0 / 255.0),
        (5122, [0, 0x80, 0, 0], -32768.0, -1.0),
        (5122, [1, 1, 0, 0], 257.0, 257.0 / 32767.0),
        (5123, [0xff, 0xff, 0, 0], 65535.0, 1.0),
        (5123, [1, 1, 0, 0], 257.0, 257.0_f32 / 65535.0),
    ] {
        for (stride, is_normalized, is_sparse) in
            [(8, false, false), (8, true, false), (12, true, true), (8, false, true)]
        {
            let one_is = if is_normalized { normalized } else { plain };
            let model = quantised(component, one, stride, is_normalized, is_sparse);
            let corners = [Vec3::ZERO, Vec3::X, Vec3::new(1.0, 1.0, 0.0), Vec3::Y].map(|corner| corner * one_is);
            assert_eq!(model.positions, corners, "{component} {one:?} {stride} {is_normalized} {is_sparse}");
            assert_eq!(model.triangles, [[0, 1, 2], [0, 2, 3]]);
            assert!(model.notes.is_empty());
        }
    }
}

/// The accessors 5, 6 and 7 are translations, rotations and scales of instances.
fn instances(node: Value, required: bool) -> Vec<(&'static str, Value)> {
    let translations = [0.0, 0.0, 0.0, 0.0, 0.0, 5.0];
    let rotations = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 0.0];
    let scales = [1.0, 1.0, 1.0, 2.0, -1.0, 1.0_f32];
    let numbers = [&translations[..], &rotations, &scales].concat();
    let bytes: Vec<u8> = numbers.iter().flat_map(|c| c.to_le_bytes()).collect();
    let mut changes = vec![
        ("/buffers/-", json!({"uri": format!("data:;base64,{}", base64::encode(&bytes)), "byteLength": bytes.len()})),
        ("/bufferViews/-", json!({"buffer": 1, "byteLength": bytes.len()})),
    ];
    for (kind, offset) in [("VEC3", 0), ("VEC4", 24), ("VEC3", 56)] {
        let accessor = json!({"bufferView": 5, "byteOffset": offset, "componentType": 5126, "type": kind, "count": 2});
        changes.push(("/accessors/-", accessor));
    }
    changes.push(("/nodes/0", node));
    changes.push(("/extensionsUsed", json!(["EXT_mesh_gpu_instancing"])));
    if required {
        changes.push(("/extensionsRequired", json!(["EXT_mesh_gpu_instancing"])));
    }
    changes
}

fn instanced(attributes: Value) -> Value {
    json!({"mesh": 0, "translation": [7, 0, 0], "extensions": {"EXT_mesh_gpu_instancing": {"attributes": attributes}}})
}

pub(super) fn instanced_square() -> Vec<(&'static str, Value)> {
    instances(instanced(json!({"TRANSLATION": 5, "ROTATION": 6, "SCALE": 7})), true)
}

#[test]
fn instances_are_expanded() {
    for required in [false, true] {
        let model = gltf(&instances(instanced(json!({"TRANSLATION": 5})), required));
        assert_eq!((model.triangles.len(), model.notes.len()), (4, 0));
        assert_eq!((model.positions[0], model.positions[4]), (Vec3::X * 7.0, Vec3::new(7.0, 0.0, 5.0)));
    }
    let all = gltf(&instanced_square());
    // The scale of the second instance maps the corner (1, 1, 0) to (2, -1, 0).
    let expected = Quat::from_xyzw(0.0, 0.0, 1.0, 0.0) * Vec3::new(2.0, -1.0, 0.0) + Vec3::new(7.0, 0.0, 5.0);
    assert_eq!(all.positions[6], expected);
    assert_eq!(all.triangles[2..], [[4, 6, 5], [4, 7, 6]], "a mirror turns the corners round");
    assert!(face_normals(&all).iter().all(|normal| normal.z > 0.0));

    let refused = |attributes: Value, words: &[&str]| refused(&instances(instanced(attributes), true), words);
    refused(json!({"TRANSLATION": 5, "SCALE": 0}), &["accessor 0: it has 4 elements", "same instances"]);
    refused(json!({"TRANSLATION": 6}), &["accessor 6: it must be Vec3"]);
    refused(json!({"ROTATION": 5}), &["accessor 5: it must be Vec4"]);
    for number in [json!(99), json!(u64::MAX), json!("5"), json!(-1)] {
        refused(json!({"TRANSLATION": number}), &["accessor", "the document has 8 accessors"]);
    }
}

pub(super) fn skinned() -> Vec<(&'static str, Value)> {
    let matrix = |z: f32| [1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, z, 1.0];
    let bytes: Vec<u8> = [matrix(-2.0), matrix(0.0)].concat().iter().flat_map(|c| c.to_le_bytes()).collect();
    vec![
        ("/buffers/-", json!({"uri": format!("data:;base64,{}", base64::encode(&bytes)), "byteLength": bytes.len()})),
        ("/bufferViews/-", json!({"buffer": 1, "byteLength": bytes.len()})),
        ("/accessors/-", json!({"bufferView": 5, "componentType": 5126, "type": "MAT4", "count": 2})),
        ("/skins", json!([{"joints": [1, 2], "inverseBindMatrices": 5}])),
        ("/nodes/0", json!({"mesh": 0, "skin": 0, "translation": [1000, 0, 0]})),
        ("/nodes/-", json!({"translation": [100, 0, 3], "children": [2]})),
        ("/nodes/-", json!({"translation": [-100, 5, 0]})),
        ("/scenes/0/nodes", json!([0])),
    ]
}

#[test]
fn the_first_joint_places_a_mesh_with_a_skin_and_its_node_does_not() {
    let model = gltf(&skinned());
    let shift = Vec3::new(100.0, 0.0, 1.0);
    let expected: Vec<Vec3> = gltf(&[]).positions.iter().map(|&position| position + shift).collect();
    assert_eq!((model.positions, model.normals), (expected, vec![Vec3::Z; 4]));
    assert_eq!(model.notes, ["1 node with a skin: its mesh is placed by the first joint and not bent"]);

    let with = |change: (&'static str, Value)| [skinned(), vec![change]].concat();
    assert_eq!(gltf(&with(("/nodes/1/scale", json!([-1, 1, 1])))).triangles, [[0, 2, 1], [0, 3, 2]]);
    assert_eq!(gltf(&with(("/skins/0", json!({"joints": [2]})))).positions[0], Vec3::new(0.0, 5.0, 3.0));
    refused(&with(("/skins/0/joints", json!([1, 99]))), &["skins[0].joints[1]:", "index out of bounds"]);
    refused(&with(("/skins/0/inverseBindMatrices", json!(0))), &["accessor 0: it must be Mat4"]);
    refused(&with(("/nodes/0/skin", json!(1))), &["nodes[0].skin:", "index out of bounds"]);
}

#[test]
fn extensions_are_read_noted_or_refused_by_name() {
    let requires = |name: &str| [("/extensionsRequired", json!([name])), ("/extensionsUsed", json!([name]))];
    for shading in ["KHR_materials_unlit", "KHR_texture_transform", "EXT_texture_webp", "KHR_lights_punctual"] {
        let model = gltf(&requires(shading));
        assert_eq!((model.triangles.len(), model.notes.len()), (2, 1), "{:?}", model.notes);
        assert!(model.notes[0].contains(&format!("`{shading}` changes no triangle")), "{:?}", model.notes);
        assert!(gltf(&requires(shading)[1..]).notes.is_empty());
    }
    for (name, words) in [
        ("EXT_meshopt_compression", "`gltfpack -noq"),
        ("KHR_draco_mesh_compression", "`gltf-transform cp"),
        ("MINE_subdivision", "export the file without it"),
    ] {
        refused(&requires(name), &["extensionsRequired: the file requires", name, words]);
        let notes = gltf(&requires(name)[1..]).notes;
        let noted = notes.iter().any(|note| note.contains("`MINE_subdivision` is ignored"));
        assert_eq!(noted, name == "MINE_subdivision", "{notes:?}");
    }
}
