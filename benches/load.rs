//! Benchmarks of reading large mesh files: `cargo bench --bench load -- obj`.

use std::fs;
use std::path::Path;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use glam::Vec3;
use sahara::scene::load;

struct Grid {
    side: usize,
}

impl Grid {
    fn positions(&self) -> impl Iterator<Item = Vec3> {
        let side = self.side;
        (0..side * side).map(move |i| {
            let [x, z] = [i % side, i / side].map(|k| k as f32 / side as f32);
            Vec3::new(x, 0.1 * (20.0 * x).sin() * (20.0 * z).cos(), z)
        })
    }

    fn triangles(&self) -> impl Iterator<Item = [usize; 3]> {
        let side = self.side;
        (0..side - 1).flat_map(move |row| {
            (0..side - 1).flat_map(move |column| {
                let a = row * side + column;
                [[a, a + side, a + 1], [a + 1, a + side, a + side + 1]]
            })
        })
    }

    fn counts(&self) -> [usize; 2] {
        [self.side * self.side, 2 * (self.side - 1) * (self.side - 1)]
    }

    fn obj(&self) -> String {
        let vertices = self.positions().map(|p| format!("v {} {} {}\n", p.x, p.y, p.z));
        vertices.chain(self.triangles().map(|t| format!("f {} {} {}\n", t[0] + 1, t[1] + 1, t[2] + 1))).collect()
    }

    fn ply(&self) -> Vec<u8> {
        let [vertices, triangles] = self.counts();
        let header = format!(
            "ply\nformat binary_little_endian 1.0\nelement vertex {vertices}\nproperty float x\nproperty float y\n\
             property float z\nelement face {triangles}\nproperty list uchar int vertex_indices\nend_header\n"
        );
        let faces = self.triangles().flat_map(|t| [&[3][..], &little(t)].concat());
        header.into_bytes().into_iter().chain(self.positions().flat_map(bytes)).chain(faces).collect()
    }

    /// Returns a glTF document and the contents of the buffer file `mesh.bin`.
    fn gltf(&self) -> (String, Vec<u8>) {
        let [vertices, triangles] = self.counts();
        let [before, after] = [12 * vertices, 12 * triangles];
        let (min, max) = self.positions().fold((Vec3::MAX, Vec3::MIN), |(min, max), p| (min.min(p), max.max(p)));
        let document = format!(
            r#"{{"asset":{{"version":"2.0"}},"buffers":[{{"uri":"mesh.bin","byteLength":{}}}],"bufferViews":[
            {{"buffer":0,"byteLength":{before}}},{{"buffer":0,"byteOffset":{before},"byteLength":{after}}}],"accessors":[
            {{"bufferView":0,"componentType":5126,"type":"VEC3","count":{vertices},"min":{:?},"max":{:?}}},
            {{"bufferView":1,"componentType":5125,"type":"SCALAR","count":{}}}],"meshes":[{{"primitives":[
            {{"attributes":{{"POSITION":0}},"indices":1}}]}}],"nodes":[{{"mesh":0}}],"scenes":[{{"nodes":[0]}}],"scene":0}}"#,
            before + after,
            min.to_array(),
            max.to_array(),
            3 * triangles,
        );
        (document, self.positions().flat_map(bytes).chain(self.triangles().flat_map(little)).collect())
    }
}

/// A glTF document in which each node draws one triangle.
fn nodes(count: usize) -> String {
    let matrix = |i: usize| format!("[1,0,0.125,0,0,1,0,0,-0.125,0,1,0,{},{},0.5,1]", i as f64 / 7.0, i as f64 / -3.0);
    let node = |i: usize| format!(r#"{{"name":"node {i}","mesh":0,"matrix":{}}}"#, matrix(i));
    format!(
        r#"{{"asset":{{"version":"2.0"}},"buffers":[{{"uri":"mesh.bin","byteLength":36}}],"bufferViews":[
        {{"buffer":0,"byteLength":36}}],"accessors":[{{"bufferView":0,"componentType":5126,"type":"VEC3","count":3}}],
        "meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}}}}]}}],"nodes":[{}]}}"#,
        (0..count).map(node).collect::<Vec<_>>().join(",")
    )
}

fn bytes(position: Vec3) -> Vec<u8> {
    position.to_array().map(f32::to_le_bytes).concat()
}

fn little(triangle: [usize; 3]) -> Vec<u8> {
    triangle.map(|corner| (corner as u32).to_le_bytes()).concat()
}

fn write(grid: &Grid, node_count: usize, folder: &Path) {
    let (document, buffer) = grid.gltf();
    let files = [
        ("mesh.obj", grid.obj().into_bytes()),
        ("mesh.ply", grid.ply()),
        ("mesh.gltf", document.into_bytes()),
        ("mesh.bin", buffer),
        ("nodes.gltf", nodes(node_count).into_bytes()),
    ];
    for (name, bytes) in files {
        fs::write(folder.join(name), bytes).expect("a temporary folder takes files");
    }
}

fn loading(criterion: &mut Criterion) {
    let is_timed = std::env::args().any(|argument| argument == "--bench");
    let (side, node_count) = if is_timed { (708, 100_000) } else { (20, 20) };
    let grid = Grid { side };
    let [_, triangles] = grid.counts();
    let folder = tempfile::tempdir().expect("a temporary folder");
    write(&grid, node_count, folder.path());

    let mut group = criterion.benchmark_group("load");
    group.sample_size(10);
    let files =
        [("mesh.obj", triangles), ("mesh.ply", triangles), ("mesh.gltf", triangles), ("nodes.gltf", node_count)];
    for (name, triangles) in files {
        let path = folder.path().join(name);
        group.throughput(Throughput::Elements(triangles as u64)).bench_function(name, |bencher| {
            bencher.iter(|| {
                let model = load(&path).expect("a mesh of our own loads");
                assert_eq!(model.triangles.len(), triangles);
                model
            });
        });
    }
    group.finish();
}

criterion_group!(benches, loading);
criterion_main!(benches);
