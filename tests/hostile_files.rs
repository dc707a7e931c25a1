//! Malformed and malicious files must be rejected with an error that names the file.
//!
//! Loading may use at most 64 MiB of memory plus twice the total size of the files. For OBJ files, the limit is
//! 64 MiB plus sixteen times the total size of the files.

use std::fs;

use sahara::measure::peak_bytes;
use sahara::scene::files::{HitFile, RayFile};
use sahara::scene::load;
use serde_json::{Value, json};

use crate::alone::alone;
use crate::cli::command::assert_contains;

/// Files in one folder. The first file is loaded.
type Files = Vec<(&'static str, Vec<u8>)>;

const SLACK: usize = 64 << 20;

/// Loads the first file. The returned error message starts at the file name.
fn loaded(files: &Files) -> Result<usize, String> {
    let (name, folder) = (files[0].0, tempfile::tempdir().unwrap());
    for (name, bytes) in files {
        fs::write(folder.path().join(name), bytes).unwrap();
    }
    let path = folder.path().join(name);
    let (result, peak) = peak_bytes(|| -> anyhow::Result<usize> {
        Ok(match path.extension().and_then(|ending| ending.to_str()) {
            Some("rays") => RayFile::read(&path)?.workload.rays.len(),
            Some("hits") => HitFile::read(&path).map(|_| 0)?,
            _ => load(&path)?.triangles.len(),
        })
    });
    let peak = peak.expect("the allocator is installed");
    let size: usize = files.iter().map(|(_, bytes)| bytes.len()).sum();
    let times = if name.ends_with(".obj") { 16 } else { 2 };
    assert!(peak <= times * size + SLACK, "{name}: {peak} bytes for files of {size}: {result:?}");
    result.map_err(|error| {
        let message = error.to_string();
        assert!(!message.contains('\n') && message.chars().count() <= 600, "{message:?}");
        let start = message.find(name).unwrap_or_else(|| panic!("{message:?} does not name {name}"));
        message[start..].to_owned()
    })
}

/// A glTF document of one mesh with `count` vertices, without indices. The positions are in `a.bin`.
fn document(count: usize) -> Value {
    json!({
        "asset": {"version": "2.0"},
        "buffers": [{"uri": "a.bin", "byteLength": 12 * count}],
        "bufferViews": [{"buffer": 0, "byteLength": 12 * count}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "type": "VEC3", "count": count}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
        "nodes": [{"mesh": 0}]
    })
}

fn gltf(document: &Value, data: usize) -> Files {
    vec![("a.gltf", document.to_string().into_bytes()), ("a.bin", vec![0; data])]
}

fn glb(json: &[u8], data: &[u8]) -> Vec<u8> {
    let mut bytes = b"glTF\x02\0\0\0".to_vec();
    bytes.extend((28 + json.len() as u32 + data.len() as u32).to_le_bytes());
    for (kind, chunk) in [(b"JSON", json), (b"BIN\0", data)] {
        bytes.extend((chunk.len() as u32).to_le_bytes());
        bytes.extend(kind);
        bytes.extend(chunk);
    }
    bytes
}

const TRIANGLE: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";

fn obj_files() -> Vec<(Files, [&'static str; 2])> {
    let obj = |text: Vec<u8>| vec![("a.obj", text)];
    let after = |start: &str, repeated: &str, times: usize, end: &str| {
        obj([start.as_bytes(), &repeated.as_bytes().repeat(times), end.as_bytes()].concat())
    };
    let names: String = (0..200_000).map(|i| format!("usemtl m{i}\nf 1 2 3\n")).collect();
    vec![
        (after("", "v 0 0 1\n", 1_000_000, "v 0 0 x\n"), ["line 1000001:", "three finite numbers are needed"]),
        (after(TRIANGLE, "f 1 1 1\n", 1_000_000, "f 1 2 x\n"), ["line 1000004:", "`x` is not a vertex index"]),
        (after("v 0 0 0\nvn 0 0 1\n", "f 1//1 1//1 1//1\n", 1_000_000, "f x"), ["line 1000003:", "not a vertex index"]),
        (after("v 0 0 0\nf", " 1", 10_000_000, "\n"), ["line 2:", "more than 1048576 corners"]),
        (after("v 0 0 0\nf", " \\\n1", 1_000_000, " x\n"), ["line 2:", "`x` is not a vertex index"]),
        (after("v 0 0 0\n", "f\n", 10_000_000, ""), ["a.obj", "has no triangles"]),
        (after("", "\u{ff}", 20_000_000, ""), ["line 1:", "OBJ keyword"]),
        (obj(b"\xff".repeat(50_000_000)), ["line 1:", "OBJ keyword"]),
        (
            obj([TRIANGLE.as_bytes(), names.as_bytes(), b"f 1 2"].concat().repeat(2)),
            ["line 400004:", "`2v` is not a vertex index"],
        ),
    ]
}

fn ply_files() -> Vec<(Files, [&'static str; 2])> {
    let ply =
        |header: &str, body: &[u8]| vec![("a.ply", [b"ply\n", header.as_bytes(), b"end_header\n", body].concat())];
    let mesh = |format: &str, vertices: u64, faces: u64| {
        format!(
            "format {format} 1.0\nelement vertex {vertices}\nproperty char x\nproperty char y\nproperty char z\n\
             element face {faces}\nproperty list uint uchar vertex_indices\n"
        )
    };
    let little = "binary_little_endian";
    let wide = [&1000_u32.to_le_bytes()[..], &[0; 1000]].concat();
    let wrong = [&[0; 3][..], &wide.repeat(15_000), &3_u32.to_le_bytes(), &[0, 0, 1]].concat();
    vec![
        (vec![("a.ply", [&b"ply\n"[..], &b"comment\n".repeat(4_000_000)].concat())], ["line 13", "does not end"]),
        (
            vec![("a.ply", [b"ply\nformat ascii 1.0\n", &b"element e 0\n".repeat(4_000_000)[..]].concat())],
            ["line 4:", "declared twice"],
        ),
        (ply("format ascii 1.0\nelement vertex -1\n", b""), ["line 3:", "not a line of a PLY header"]),
        (ply(&mesh(little, 1 << 49, 1), &[0; 100]), ["element vertex:", "rows"]),
        (ply(&mesh(little, 1, 1 << 49), &[0; 100]), ["element face:", "rows"]),
        (ply(&mesh(little, 1, 15_001), &wrong), ["face 15000:", "its corner 1 is not one of the 1"]),
        (ply(&mesh("ascii", 1, 1), b"0 0 \xff\n3 0 0 0\n"), ["vertex 0:", "not ASCII text"]),
    ]
}

fn gltf_files() -> Vec<(Files, [&'static str; 2])> {
    let text = |text: Vec<u8>| vec![("a.gltf", text)];
    let with = |pointer: &str, value: Value| {
        let mut document = document(3);
        let (parent, key) = pointer.rsplit_once('/').unwrap();
        document.pointer_mut(parent).unwrap()[key] = value;
        gltf(&document, 36)
    };
    let list = |start: &str, item: &str, times: usize| {
        let start = format!("{{\"asset\":{{\"version\":\"2.0\"}},{start}[");
        text([start.as_bytes(), &item.as_bytes().repeat(times), b"{}]}"].concat())
    };

    // Number of vertices whose positions fit in 1 MiB.
    let megabyte = 87_381;
    let with_primitives = |accessors: &[usize]| {
        let mut document = document(megabyte);
        let mut beyond = document["accessors"][0].clone();
        beyond["count"] = (megabyte + 1).into();
        document["accessors"].as_array_mut().unwrap().extend(accessors.contains(&1).then_some(beyond));
        let mesh = |accessor: &usize| json!({"primitives": [{"attributes": {"POSITION": accessor}}]});
        document["meshes"] = accessors.iter().map(mesh).collect();
        document["nodes"] = (0..accessors.len()).map(|mesh| json!({"mesh": mesh})).collect();
        document
    };
    let mut buffers = with_primitives(&[1]);
    buffers["buffers"] = (0..30_000).map(|_| json!({"uri": "a.bin", "byteLength": 12 * megabyte})).collect();

    let mut embedded = document(3);
    embedded["accessors"][0]["count"] = 4.into();
    embedded["bufferViews"][0]["byteLength"] = 36.into();
    embedded["buffers"][0]["uri"] =
        format!("data:application/octet-stream;base64,{}", "AAAA".repeat(10_000_000)).into();
    let mut binary = document(3);
    binary["accessors"][0]["count"] = 4.into();
    binary["buffers"][0].as_object_mut().unwrap().remove("uri");
    let chunk = vec![0; 80_000_000];

    vec![
        (text(vec![]), ["a.gltf", "not a glTF 2.0 file"]),
        (text(b"{\"asset\":{\"version\":\"2.0\"}}\xff".to_vec()), ["line 1 column", "not a glTF 2.0 file"]),
        (text(b"\xff\xfe{\0".to_vec()), ["line 1:", "UTF-16"]),
        (text(b"[".repeat(5_000_000)), ["a.gltf", "5000000 entries"]),
        (text(b"{\"a\":".repeat(60_000)), ["line 1 column", "not a glTF 2.0 file"]),
        (list("\"nodes\":", "{},", 10_000_000), ["a.gltf", "10000003 objects"]),
        (list("\"accessors\":[{\"min\":", "0,", 20_000_000), ["a.gltf", "entries"]),
        (
            with("/nodes", (0..50_000).map(|i| json!({"children": [i + 1]})).collect()),
            ["nodes[49999]", "out of bounds"],
        ),
        (with("/buffers/0/byteLength", json!(u64::MAX)), ["buffer 0:", "it is truncated"]),
        (gltf(&buffers, 12 * megabyte), ["accessor 1:", "reach beyond"]),
        (gltf(&with_primitives(&[&[0; 2000][..], &[1]].concat()), 12 * megabyte), ["accessor 1:", "reach beyond"]),
        (gltf(&with_primitives(&[0; 2000]), 12 * megabyte), ["a.gltf", "174762000 vertices"]),
        (text(embedded.to_string().into_bytes()), ["accessor 0:", "4 elements reach beyond the 36 bytes"]),
        (vec![("a.glb", glb(binary.to_string().as_bytes(), &chunk))], ["accessor 0:", "4 elements reach beyond"]),
    ]
}

fn ray_files() -> Vec<(Files, [&'static str; 2])> {
    let head = |magic: &[u8], count: u64| [magic, &[1, 0, 0, 0, 0, 0, 0, 0], &count.to_le_bytes(), &[0; 48]].concat();
    vec![
        (vec![("a.rays", head(b"SAHARAYS", 0))], ["a.rays", "the first item begins at byte 96"]),
        (vec![("a.rays", head(b"SAHARAYS", u64::MAX))], ["a.rays", "truncated"]),
        (vec![("a.rays", [head(b"SAHARAYS", 1 << 59), vec![0; 99]].concat())], ["a.rays", "truncated"]),
        (vec![("a.hits", head(b"SAHAHITS", u64::MAX))], ["a.hits", "truncated"]),
    ]
}

/// Runs in a separate process, because allocations of other tests would change the measured memory peak.
#[test]
fn each_is_refused_in_a_sentence_and_takes_little_memory() {
    if !alone("hostile_files::each_is_refused_in_a_sentence_and_takes_little_memory") {
        return;
    }
    let all = obj_files().into_iter().chain(ply_files()).chain(gltf_files()).chain(ray_files());
    for (files, words) in all {
        assert_contains(&loaded(&files).expect_err(words[1]), &words);
    }

    // Valid files have the same memory limit.
    for (faces, triangles) in
        [("f 1 1 1\n", 1), ("f 1 1 1 1 1\n", 3), ("usemtl a\nf 1//1 1//1 1//1\nusemtl b\nf 1 1 1\n", 2)]
    {
        let times = 8_000_000 / faces.len();
        let text = [b"v 0 0 0\nvn 0 0 1\n", &faces.as_bytes().repeat(times)[..]].concat();
        assert_eq!(loaded(&vec![("a.obj", text)]), Ok(triangles * times));
    }
    // Many buffers refer to one file, which must be read only once.
    let mut often = document(1_000_000);
    often["buffers"] = (0..30_000).map(|_| json!({"uri": "a.bin", "byteLength": 12_000_000})).collect();
    often["accessors"][0]["count"] = 300.into();
    assert_eq!(loaded(&gltf(&often, 12_000_000)), Ok(100));
    // The load time must not grow quadratically with the number of missing material libraries.
    let missing: String = (0..300_000).map(|i| format!("mtllib {i}\n")).collect();
    assert_eq!(loaded(&vec![("a.obj", format!("{missing}{TRIANGLE}f 1 2 3\n").into_bytes())]), Ok(1));
    let libraries = [b"mtllib a.mtl\n".repeat(100_000), format!("{TRIANGLE}usemtl a\nf 1 2 3\n").into_bytes()].concat();
    let materials: String = (0..300_000).map(|i| format!("newmtl a{i}\nKd x\n")).collect();
    assert_eq!(loaded(&vec![("a.obj", libraries), ("a.mtl", materials.into_bytes())]), Ok(1));
}
