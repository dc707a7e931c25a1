//! Errors of mesh files.

use std::fmt::Display;
use std::path::PathBuf;

use crate::escaped::Escaped as _;
use crate::geometry::MeshError;

/// Each message is one line.
#[derive(Debug, thiserror::Error)]
pub enum LoadError {
    #[error("{}: unknown extension: use an .obj, .ply, .gltf or .glb file", file.escaped())]
    UnknownFormat { file: PathBuf },
    #[error("{}: this is a folder: name a mesh file in it (.obj, .ply, .gltf or .glb) or a scene file (.toml)", file.escaped())]
    Folder { file: PathBuf },
    #[error("{}: cannot read the file ({cause}): check that it exists and its permissions", file.escaped())]
    Unreadable { file: PathBuf, cause: std::io::Error },
    /// `place` is empty, or begins with a comma as in `, line 3`.
    #[error("{}{place}: {problem}", file.escaped())]
    Malformed { file: PathBuf, place: String, problem: String },
    /// The indices in `cause` start at 0.
    #[error("{}: {cause}", file.escaped())]
    Mesh { file: PathBuf, cause: MeshError },
}

/// A problem in a file, without the name of the file.
#[derive(Debug)]
pub(super) struct Fault {
    pub place: String,
    pub problem: String,
}

impl Fault {
    pub fn file(problem: impl Into<String>) -> Self {
        Self { place: String::new(), problem: problem.into() }
    }

    pub fn line(line: usize, problem: impl Into<String>) -> Self {
        Self::part(format!("line {line}"), problem)
    }

    /// `part` names a part of the file, such as `accessor 3`. Numbers count from 0, except line numbers.
    pub fn part(part: impl Display, problem: impl Into<String>) -> Self {
        Self { place: format!(", {part}"), problem: problem.into() }
    }
}

pub(super) fn quoted(text: impl AsRef<[u8]>) -> String {
    const LONGEST: usize = 60;
    let text = text.as_ref().trim_ascii();
    // A character has at most four bytes in UTF-8.
    let start = String::from_utf8_lossy(&text[..text.len().min(4 * LONGEST + 4)]);
    let escaped: String = start.chars().take(LONGEST).flat_map(char::escape_debug).collect();
    let more = if start.chars().nth(LONGEST).is_some() { "..." } else { "" };
    format!("`{escaped}{more}`")
}
