#![doc = include_str!("FORMAT.md")]

mod bytes;
mod exact_hits;
mod hits;
mod mesh;
mod rays;
#[cfg(test)]
mod tests;

use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};

use crate::escaped::Escaped as _;
use crate::output::OutputError;

pub use bytes::RaysId;
pub use exact_hits::{ExactHit, exact_hits_bytes};
pub use hits::{HitFile, hits_from_bytes, hits_to_bytes};
pub use mesh::mesh_bytes;
pub use rays::RayFile;

#[derive(Debug, thiserror::Error)]
pub enum FileError {
    #[error("cannot read {}: {cause}: check that it exists and its permissions", path.escaped())]
    Read { path: PathBuf, cause: std::io::Error },
    #[error("{}: {problem}", path.escaped())]
    Content { path: PathBuf, problem: String },
    #[error(transparent)]
    Write(#[from] OutputError),
}

/// Stops after 8 bytes if the file does not begin with `magic`. The file may be endless.
fn read<F>(path: &Path, magic: &[u8; 8], parse: fn(&[u8]) -> Result<F, String>) -> Result<F, FileError> {
    let bytes = || {
        let (mut file, mut bytes) = (File::open(path)?, vec![]);
        file.by_ref().take(8).read_to_end(&mut bytes)?;
        if bytes == magic {
            file.read_to_end(&mut bytes)?;
        }
        Ok(bytes)
    };
    let bytes: Vec<u8> = bytes().map_err(|cause| FileError::Read { path: path.into(), cause })?;
    parse(&bytes).map_err(|problem| FileError::Content { path: path.into(), problem })
}
