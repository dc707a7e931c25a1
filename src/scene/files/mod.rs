#![doc = include_str!("FORMAT.md")]

mod bytes;
mod hits;
mod mesh;
mod rays;
#[cfg(test)]
mod tests;
mod truth;

use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};

use crate::output::OutputError;

pub use hits::{HitFile, RaysId};
pub use mesh::{mesh_bytes, write_mesh};
pub use rays::RayFile;
pub use truth::TruthFile;

/// Why a file of rays or answers cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum FileError {
    #[error("cannot read {}: {cause}: check that it exists and may be read", path.display())]
    Read { path: PathBuf, cause: std::io::Error },
    #[error("{}: {problem}", path.display())]
    Content { path: PathBuf, problem: String },
    #[error(transparent)]
    Write(#[from] OutputError),
}

/// The bytes of a file; of one that does not begin with `magic` its beginning only, for it may be large or without an
/// end.
fn read(path: &Path, magic: &[u8; 8]) -> Result<Vec<u8>, FileError> {
    let bytes = || {
        let (mut file, mut bytes) = (File::open(path)?, vec![]);
        file.by_ref().take(8).read_to_end(&mut bytes)?;
        if bytes == magic {
            file.read_to_end(&mut bytes)?;
        }
        Ok(bytes)
    };
    bytes().map_err(|cause| FileError::Read { path: path.into(), cause })
}

fn content(path: &Path) -> impl Fn(String) -> FileError {
    move |problem| FileError::Content { path: path.into(), problem }
}
