//! Errors of scenes.

use std::path::PathBuf;

use glam::Vec3;

use super::{CameraError, LoadError};
use crate::escaped::Escaped as _;
use crate::geometry::MeshError;

/// Each message is one line.
#[derive(Debug, thiserror::Error)]
pub enum SceneError {
    #[error("{}: cannot read the scene ({cause}): check that it exists and its permissions", file.escaped())]
    Unreadable { file: PathBuf, cause: std::io::Error },
    #[error("{file}, line {line}: {problem}")]
    Syntax { file: String, line: usize, problem: String },
    #[error("{file}, `{key}`: {problem}")]
    Value { file: String, key: String, problem: String },
    #[error("{file}, `camera`: {cause}")]
    Camera { file: String, cause: CameraError },
    #[error("{file}, `{key}`: {cause}")]
    Load { file: String, key: String, cause: LoadError },
    #[error("{file}: its coordinates range from {:?} to {:?}, where f32 cannot represent a camera in front of it: \
             scale it, or move it nearer to 0", min.to_array(), max.to_array())]
    Extent { file: String, min: Vec3, max: Vec3 },
    #[error("{file}: {cause}")]
    Mesh { file: String, cause: MeshError },
    #[error("there is no built-in scene `{name}`{suggestion}; the scenes are {all}; name files with their extension")]
    Unknown { name: String, suggestion: String, all: String },
}
