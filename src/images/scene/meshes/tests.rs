//! Checks each mesh against known properties.

use std::collections::{HashMap, HashSet};

use sha2::{Digest, Sha256};

use super::*;
use crate::geometry::{Aabb, Mesh};
use crate::scene::hash::hexadecimal;

/// Counts edges with one triangle and edges with more than two triangles. Vertices at the same point are merged.
fn loose_and_crowded_edges(mesh: &Mesh) -> (usize, usize) {
    let mut edges: HashMap<_, u32> = HashMap::new();
    for triangle in mesh.solid() {
        let [a, b, c] = mesh.corners(triangle).map(|p| (p + 0.0).to_array().map(f32::to_bits));
        for (p, q) in [(a, b), (b, c), (c, a)] {
            *edges.entry((p.min(q), p.max(q))).or_default() += 1;
        }
    }
    let count = |wanted: fn(u32) -> bool| edges.values().filter(|&&n| wanted(n)).count();
    (count(|n| n == 1), count(|n| n > 2))
}

fn pieces(model: &Model) -> usize {
    sdf::pieces(model.positions.len(), &model.triangles).into_iter().collect::<HashSet<_>>().len()
}

fn fingerprint(model: &Model) -> String {
    let mut hasher = Sha256::new();
    model.positions.iter().flat_map(|p| p.to_array()).for_each(|x| hasher.update(x.to_bits().to_le_bytes()));
    model.triangles.as_flattened().iter().for_each(|i| hasher.update(i.to_le_bytes()));
    hexadecimal(&hasher.finalize()[..8])
}

struct Known {
    name: &'static str,
    vertices: usize,
    triangles: usize,
    degenerate: usize,
    pieces: usize,
    /// The result of [`loose_and_crowded_edges`].
    edges: (usize, usize),
    bounds: Aabb,
    fingerprint: &'static str,
}

const UNIT: Aabb = Aabb { min: Vec3::NEG_ONE, max: Vec3::ONE };

const fn bounds(x: [f32; 2], y: [f32; 2], z: [f32; 2]) -> Aabb {
    Aabb { min: Vec3::new(x[0], y[0], z[0]), max: Vec3::new(x[1], y[1], z[1]) }
}

#[rustfmt::skip]
const KNOWN: &[Known] = &[
    Known { name: "cube", vertices: 8, triangles: 12, degenerate: 0, pieces: 1, edges: (0, 0), bounds: UNIT, fingerprint: "c33b2908906d0646" },
    Known { name: "plane_y", vertices: 4, triangles: 2, degenerate: 0, pieces: 1, edges: (4, 0), bounds: bounds([-1.0, 1.0], [0.0, 0.0], [-1.0, 1.0]), fingerprint: "ffb7b73d3ac68d6b" },
    Known { name: "cornellbox", vertices: 8, triangles: 10, degenerate: 0, pieces: 1, edges: (4, 0), bounds: UNIT, fingerprint: "70ea93f70f24b40c" },
    Known { name: "icosahedron", vertices: 12, triangles: 20, degenerate: 0, pieces: 1, edges: (0, 0), bounds: bounds([-0.894_425, 0.894_425], [-1.0, 1.0], [-0.850_64, 0.850_64]), fingerprint: "051e2870bf35b38f" },
    Known { name: "inside_out_icosahedron", vertices: 12, triangles: 20, degenerate: 0, pieces: 1, edges: (0, 0), bounds: bounds([-0.894_425, 0.894_425], [-1.0, 1.0], [-0.850_64, 0.850_64]), fingerprint: "7cc5eb04bd422730" },
    Known { name: "icosphere", vertices: 642, triangles: 1280, degenerate: 0, pieces: 1, edges: (0, 0), bounds: UNIT, fingerprint: "ff390a8402a37d2d" },
    Known { name: "uv_sphere", vertices: 1080, triangles: 2080, degenerate: 80, pieces: 1, edges: (0, 0), bounds: UNIT, fingerprint: "9517e478fb52a5bd" },
    Known { name: "torus", vertices: 1152, triangles: 2304, degenerate: 0, pieces: 1, edges: (0, 0), bounds: bounds([-1.37, 1.37], [-0.37, 0.37], [-1.37, 1.37]), fingerprint: "494ecd3399d3ce76" },
    Known { name: "teapot", vertices: 2082, triangles: 4032, degenerate: 0, pieces: 4, edges: (128, 0), bounds: teapot::BOUNDS, fingerprint: "0665179f76707926" },
    Known { name: "rabbit", vertices: 772, triangles: 1532, degenerate: 0, pieces: 3, edges: (0, 0), bounds: bounds([-1.593, 1.593], [0.0, 4.446], [-2.554, 2.349]), fingerprint: "931b060059f36c68" },
    Known { name: "fox", vertices: 693, triangles: 1374, degenerate: 0, pieces: 3, edges: (0, 0), bounds: bounds([-2.451, 2.451], [0.0, 5.484], [-3.901, 1.881]), fingerprint: "7971a6993d7fbde9" },
    Known { name: "elephant", vertices: 792, triangles: 1572, degenerate: 0, pieces: 3, edges: (0, 0), bounds: bounds([-2.785, 2.785], [0.002, 7.15], [-3.72, 4.736]), fingerprint: "4e8ec9f72bb0c3b9" },
    Known { name: "dragon", vertices: 65_415, triangles: 130_858, degenerate: 0, pieces: 1, edges: (0, 0), bounds: bounds([-0.102, 0.102], [0.0, 0.144], [-0.046, 0.046]), fingerprint: "355d211535ade223" },
    Known { name: "lucy", vertices: 137_835, triangles: 275_690, degenerate: 0, pieces: 1, edges: (0, 0), bounds: bounds([-6.74, 6.74], [0.0, 23.15], [-3.87, 3.87]), fingerprint: "84b49e7f5aae0aa1" },
    Known { name: "sponza", vertices: 153_288, triangles: 174_838, degenerate: 0, pieces: 14_523, edges: (49_766, 1764), bounds: bounds([-1921.0, 1800.0], [-126.0, 1429.0], [-1183.0, 1105.0]), fingerprint: "3bf9bc78684c66f7" },
    Known { name: "two_cities", vertices: 4417, triangles: 7426, degenerate: 0, pieces: 290, edges: (252, 0), bounds: bounds([-1.0, 1.0], [0.0, 0.249_142_44], [-1.0, 1.0]), fingerprint: "6679b16641656a67" },
    Known { name: "shared_faces", vertices: 8000, triangles: 12_000, degenerate: 0, pieces: 1000, edges: (0, 6210), bounds: bounds([-0.5, 9.5], [-0.5, 9.5], [-0.5, 9.5]), fingerprint: "67398947b20d5cfd" },
    Known { name: "tiled_floor", vertices: 12_804, triangles: 19_202, degenerate: 0, pieces: 1601, edges: (4, 4693), bounds: bounds([-1.0, 1.0], [0.0, 0.02], [-1.0, 1.0]), fingerprint: "0ead9dda660df537" },
    Known { name: "fan", vertices: 1501, triangles: 1500, degenerate: 0, pieces: 1, edges: (1500, 0), bounds: bounds([-1.0, 1.0], [-1.0, 1.0], [0.0, 0.0]), fingerprint: "418d5c5f2b924619" },
    Known { name: "near_duplicates", vertices: 15_000, triangles: 5000, degenerate: 0, pieces: 5000, edges: (14, 2114), bounds: bounds([-1.100_000_1, 1.300_000_1], [-0.900_000_04, 1.200_000_2], [-0.400_000_04, 0.300_000_04]), fingerprint: "ad596224925d48c8" },
    Known { name: "growing_shells", vertices: 2264, triangles: 3396, degenerate: 0, pieces: 283, edges: (0, 0), bounds: bounds([-266.223_36, 266.223_36], [-266.223_36, 266.223_36], [-266.223_36, 266.223_36]), fingerprint: "1eb57e4815e770ed" },
];

fn assert_normals(name: &str, model: &Model) {
    assert!(model.normal_indices.is_empty() || model.normal_indices.len() == model.triangles.len(), "{name}");
    // Some generators truncate normals to multiples of 1/32767, so the lengths may be slightly below 1.
    assert!(model.normals.iter().all(|n| (0.9999..1.000_001).contains(&n.length())), "{name}");
    // In meshes made from distance functions, a vertex normal at a sharp bend may point to the back of a triangle.
    let is_coarse = ["rabbit", "fox", "elephant", "dragon", "lucy"].contains(&name);
    for (corners, normals) in model.triangles.iter().zip(&model.normal_indices) {
        let [a, b, c] = corners.map(|i| model.positions[i as usize]);
        let face = (b - a).cross(c - a);
        if *normals != [Model::FLAT; 3] {
            let faces = normals.map(|i| face.dot(model.normals[i as usize]) >= 0.0);
            assert!(is_coarse || faces == [true; 3], "{name}");
        }
    }
}

#[test]
fn every_mesh_has_its_known_properties() {
    assert_eq!(GENERATORS.iter().map(|g| g.name).collect::<Vec<_>>(), KNOWN.iter().map(|k| k.name).collect::<Vec<_>>());
    for known in KNOWN {
        let (name, model) = (known.name, by_name(known.name).unwrap());
        let mesh = Mesh::new(model.positions.clone(), model.triangles.clone()).unwrap();
        let counts = [model.positions.len(), mesh.len(), mesh.degenerate().len(), pieces(&model)];
        assert_eq!(counts, [known.vertices, known.triangles, known.degenerate, known.pieces], "{name}");
        assert_eq!(loose_and_crowded_edges(&mesh), known.edges, "edges of {name}");
        assert_eq!(mesh.bounds(), known.bounds, "bounds of {name}");
        assert_eq!(fingerprint(&model), known.fingerprint, "fingerprint of {name}");
        assert_normals(name, &model);
        assert!(model.material_of.is_empty() || model.material_of.len() == known.triangles, "materials of {name}");
        assert!(model.material_of.iter().all(|&m| (m as usize) < model.materials.len()), "materials of {name}");
    }
}
