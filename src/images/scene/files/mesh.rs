//! Encodes a mesh as a PLY file.

use crate::geometry::Mesh;

/// The bytes of a PLY file. Triangle n becomes face n.
pub fn mesh_bytes(mesh: &Mesh) -> Vec<u8> {
    let header = format!(
        "ply\nformat binary_little_endian 1.0\nelement vertex {}\nproperty float x\nproperty float y\nproperty float z\n\
         element face {}\nproperty list uchar int vertex_indices\nend_header\n",
        mesh.positions().len(),
        mesh.len()
    );
    let mut bytes = header.into_bytes();
    bytes.reserve_exact(12 * mesh.positions().len() + 13 * mesh.len());
    bytes.extend(mesh.positions().iter().flat_map(|position| position.to_array()).flat_map(f32::to_le_bytes));
    for triangle in mesh.triangles() {
        bytes.push(3);
        bytes.extend(triangle.map(u32::to_le_bytes).as_flattened());
    }
    bytes
}
