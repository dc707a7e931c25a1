//! What the tests of all generated meshes ask.

use sha2::{Digest, Sha256};

use crate::{geometry::Mesh, scene::Model};

/// Checks counts, degenerate triangles, normals and materials, and returns the validated mesh.
pub fn sound(model: &Model, triangles: usize) -> Mesh {
    let mesh = Mesh::new(model.positions.clone(), model.triangles.clone()).unwrap();
    assert_eq!(mesh.len(), triangles);
    assert_eq!(mesh.degenerate(), [0u32; 0], "degenerate triangles");

    assert_eq!(model.normal_indices.len(), triangles);
    assert!(model.normals.iter().all(|n| (n.length() - 1.0).abs() < 1e-6), "a normal is not of unit length");
    for corners in &model.normal_indices {
        let flat = corners.iter().filter(|&&n| n == Model::FLAT).count();
        assert!(flat == 3 || corners.iter().all(|&n| (n as usize) < model.normals.len()), "normals {corners:?}");
    }
    assert!(model.material_of.is_empty() || model.material_of.len() == triangles);
    assert!(model.material_of.iter().all(|&m| (m as usize) < model.materials.len()));
    mesh
}

/// Checks that every edge belongs to exactly two triangles, which walk it in opposite directions, and returns the number
/// of pieces that do not hang together.
pub fn closed_pieces(model: &Model) -> usize {
    let walks = |t: &[u32; 3]| [(t[0], t[1]), (t[1], t[2]), (t[2], t[0])];
    let mut forward: Vec<_> = model.triangles.iter().flat_map(walks).collect();
    let mut backward: Vec<_> = forward.iter().map(|&(a, b)| (b, a)).collect();
    forward.sort_unstable();
    backward.sort_unstable();
    assert!(forward.windows(2).all(|w| w[0] != w[1]), "an edge is walked twice in one direction");
    assert!(forward == backward, "an edge has only one triangle");

    // Union of vertices along edges.
    let mut parent: Vec<u32> = (0..model.positions.len() as u32).collect();
    fn root(parent: &mut [u32], mut v: u32) -> u32 {
        while parent[v as usize] != v {
            parent[v as usize] = parent[parent[v as usize] as usize];
            v = parent[v as usize];
        }
        v
    }
    for &(a, b) in &forward {
        let (a, b) = (root(&mut parent, a), root(&mut parent, b));
        parent[a as usize] = b;
    }
    (0..parent.len()).filter(|&v| parent[v] == v as u32).count()
}

/// Hash of positions and indices: the same on every machine, whatever the number of threads.
pub fn fingerprint(model: &Model) -> String {
    let mut hash = Sha256::new();
    model.positions.iter().flat_map(|p| p.to_array()).for_each(|x| hash.update(x.to_le_bytes()));
    model.triangles.iter().flatten().for_each(|i| hash.update(i.to_le_bytes()));
    hash.finalize().iter().take(8).map(|byte| format!("{byte:02x}")).collect()
}
