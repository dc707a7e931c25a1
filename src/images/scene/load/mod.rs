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

/// The extension determines the format: `.obj`, `.ply`, `.gltf` or `.glb`, in upper or lower case.
///
/// [`Model::notes`] reports ignored and replaced parts of the file. The model has at least one material and one
/// triangle. [`Mesh::new`] accepts the positions and triangles of the model.
///
/// A reference whose path leads outside the folder of `path` is not followed. Symbolic links in the folder are
/// followed, even to files outside the folder.
///
/// A file is checked before memory is allocated for its triangles. The size of the files limits
/// this memory, plus a constant for glTF.
///
/// # Errors
/// The causes are:
/// - an unknown extension,
/// - an unreadable file,
/// - a violation of the format, an unsupported feature or an exceeded limit,
/// - a vertex that is not finite,
/// - an index that is out of range,
/// - a file without triangles.
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
