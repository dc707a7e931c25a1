use std::path::{Path, PathBuf};

use super::FetchError;
use crate::measure::program::file_sha256;
use crate::scene::format::RealMesh;

#[derive(Clone, Debug, PartialEq, Eq)]
pub struct DataFile {
    pub url: String,
    pub path: PathBuf,
    /// SHA-256 in lowercase hexadecimal.
    pub sha256: String,
    pub bytes: Option<u64>,
}

impl DataFile {
    /// # Errors
    /// If `real.sha256` is `None` or `real.unpack` is `Some`. If the URL begins with neither `https://` nor `http://`.
    pub fn new(real: &RealMesh, folder: &Path) -> Result<Self, FetchError> {
        let RealMesh { file, url, sha256, unpack, bytes, .. } = real.clone();
        if unpack.is_none() && !["https://", "http://"].iter().any(|scheme| url.starts_with(scheme)) {
            return Err(FetchError::UnsupportedUrl { file, url });
        }
        match sha256 {
            Some(sha256) if unpack.is_none() => {
                Ok(Self { url, path: folder.join(file), sha256: sha256.to_lowercase(), bytes })
            }
            _ => Err(FetchError::NoHash { file, url, unpack, folder: folder.into() }),
        }
    }

    /// # Errors
    /// If an existing file has the wrong SHA-256 or cannot be read.
    pub fn is_there(&self) -> Result<bool, FetchError> {
        if !self.path.exists() {
            return Ok(false);
        }
        let found = hash(&self.path)?;
        if found == self.sha256 {
            return Ok(true);
        }
        Err(FetchError::OtherContents { path: self.path.clone(), found, expected: self.sha256.clone() })
    }

    /// # Errors
    /// If `part` has the wrong SHA-256 or cannot be read.
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
