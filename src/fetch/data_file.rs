use std::path::{Path, PathBuf};

use super::FetchError;
use crate::measure::program::file_sha256;
use crate::scene::format::RealMesh;

/// A file to download into the folder of real meshes: its path and its expected contents.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct DataFile {
    /// The address of the download.
    pub url: String,
    /// The path of the finished file.
    pub path: PathBuf,
    /// SHA-256 in hexadecimal.
    pub sha256: String,
    /// The size of the file, if the scene file gives it.
    pub bytes: Option<u64>,
}

impl DataFile {
    /// # Errors
    /// If the scene file has no hash, the file must be unpacked, or its URL is not HTTP.
    pub fn new(real: &RealMesh, folder: &Path) -> Result<Self, FetchError> {
        let RealMesh { file, url, sha256, unpack, bytes, .. } = real.clone();
        if unpack.is_none() && !["https://", "http://"].iter().any(|scheme| url.starts_with(scheme)) {
            return Err(FetchError::Address { file, url });
        }
        match sha256 {
            Some(sha256) if unpack.is_none() => {
                Ok(Self { url, path: folder.join(file), sha256: sha256.to_lowercase(), bytes })
            }
            _ => Err(FetchError::NoHash { file, url, unpack, folder: folder.into() }),
        }
    }

    /// Whether the file exists with the expected contents.
    ///
    /// # Errors
    /// If it exists with other contents, or cannot be read.
    pub fn is_there(&self) -> Result<bool, FetchError> {
        if !self.path.exists() {
            return Ok(false);
        }
        let found = hash(&self.path)?;
        if found == self.sha256 {
            return Ok(true);
        }
        Err(FetchError::Other { path: self.path.clone(), found, expected: self.sha256.clone() })
    }

    /// Checks that the download at `part` has the expected contents.
    ///
    /// # Errors
    /// If the hash differs, or the file cannot be read.
    pub fn verify(&self, part: &Path) -> Result<(), FetchError> {
        let found = hash(part)?;
        if found == self.sha256 {
            return Ok(());
        }
        Err(FetchError::Hash { url: self.url.clone(), found, expected: self.sha256.clone() })
    }
}

fn hash(path: &Path) -> Result<String, FetchError> {
    file_sha256(path).map_err(|cause| FetchError::Read { path: path.into(), cause })
}
