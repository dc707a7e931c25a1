//! Mesh files: Wavefront OBJ with MTL, PLY, and glTF 2.0.

mod error;
mod files;
mod gltf;
mod mtl;
mod notes;
mod obj;
mod ply;
#[cfg(test)]
mod tests;
mod text;

use std::path::Path;

use self::error::Fault;
use self::files::read_start;
use super::Model;
use crate::geometry::Mesh;

pub use error::LoadError;

/// Reads a mesh file. Its extension, in any case, determines the format: `.obj`, `.ply`, `.gltf` or `.glb`.
///
/// Polygons are split into triangles, glTF node graphs are expanded, textures are ignored. [`Model::notes`] lists what
/// was left out or replaced. The model has at least one material and one triangle, and [`Mesh::new`] accepts its
/// arrays.
///
/// Files that the file refers to are read if their path stays below its folder; a symbolic link there may lead
/// anywhere. A file is checked before memory is allocated for its triangles, and the memory is limited by its size: a
/// glTF file has at most 2^24 triangles and vertices more than its files have bytes, its text at most 2^16 objects and
/// one for each 48 bytes, and a face of a PLY file at most 2^20 corners.
///
/// # Errors
/// A file that cannot be read or breaks its format, a vertex that is not finite, an index out of range, no triangles.
pub fn load(path: &Path) -> Result<Model, LoadError> {
    if path.is_dir() {
        return Err(LoadError::Folder { file: path.into() });
    }
    let ending = path.extension().map(|e| e.to_string_lossy().to_ascii_lowercase());
    let read: fn(Vec<u8>, &Path) -> Result<Model, Fault> = match ending.as_deref() {
        Some("obj") => |bytes, folder| obj::read(&bytes, folder),
        Some("ply") => |bytes, _| ply::read(&bytes),
        Some("gltf" | "glb") => gltf::read,
        _ => return Err(LoadError::UnknownFormat { file: path.into() }),
    };

    let file = || path.to_path_buf();
    let bytes = read_start(path, u64::MAX).map_err(|cause| LoadError::Unreadable { file: file(), cause })?;
    let malformed = |Fault { place, problem }| LoadError::Malformed { file: file(), place, problem };
    let mut model = read(bytes, path.parent().unwrap_or(Path::new(""))).map_err(malformed)?;
    Mesh::check(&model.positions, &model.triangles).map_err(|cause| LoadError::Mesh { file: file(), cause })?;
    model.flatten_invalid_normals();
    Ok(model)
}
