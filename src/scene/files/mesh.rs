//! Files of meshes.

use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::Path;

use crate::geometry::Mesh;

/// Writes all triangles of `mesh` as a PLY file in the format of the document. Triangle n becomes face n.
///
/// # Errors
/// If the file cannot be written.
pub fn write_mesh(mesh: &Mesh, path: &Path) -> io::Result<()> {
    let mut file = BufWriter::with_capacity(1 << 16, File::create(path)?);
    write_to(mesh, &mut file)?;
    file.flush()
}

/// The bytes of the file that [`write_mesh`] writes.
pub fn mesh_bytes(mesh: &Mesh) -> Vec<u8> {
    let mut bytes = vec![];
    write_to(mesh, &mut bytes).expect("memory takes everything");
    bytes
}

fn write_to(mesh: &Mesh, file: &mut impl Write) -> io::Result<()> {
    write!(
        file,
        "ply\nformat binary_little_endian 1.0\nelement vertex {}\nproperty float x\nproperty float y\nproperty float z\n\
         element face {}\nproperty list uchar int vertex_indices\nend_header\n",
        mesh.positions().len(),
        mesh.len()
    )?;
    for position in mesh.positions() {
        position.to_array().into_iter().try_for_each(|x| file.write_all(&x.to_le_bytes()))?;
    }
    for triangle in mesh.triangles() {
        file.write_all(&[3])?;
        triangle.iter().try_for_each(|corner| file.write_all(&corner.to_le_bytes()))?;
    }
    Ok(())
}
