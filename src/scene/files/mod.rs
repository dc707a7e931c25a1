#![doc = include_str!("FORMAT.md")]

mod bytes;
mod hits;
mod rays;
#[cfg(test)]
mod tests;

use std::path::{Path, PathBuf};

use crate::output::OutputError;

pub use hits::HitFile;
pub use rays::RayFile;

/// Why a file of rays or hits cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum FileError {
    #[error("cannot read {}: {cause}: check that it exists and may be read", path.display())]
    Read { path: PathBuf, cause: std::io::Error },
    #[error("{}: {problem}", path.display())]
    Content { path: PathBuf, problem: String },
    #[error(transparent)]
    Write(#[from] OutputError),
}

fn read(path: &Path) -> Result<Vec<u8>, FileError> {
    std::fs::read(path).map_err(|cause| FileError::Read { path: path.into(), cause })
}

fn content(path: &Path) -> impl Fn(String) -> FileError {
    move |problem| FileError::Content { path: path.into(), problem }
}
