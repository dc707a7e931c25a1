use std::fs::{self, File};
use std::io;
use std::path::{Path, PathBuf};

use sha2::{Digest, Sha256};

use super::FetchError;
use crate::scene::format::RealMesh;

/// A file of the folder of real meshes: its path and its expected contents.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct DataFile {
    /// Where it can be downloaded.
    pub url: String,
    /// The finished file.
    pub path: PathBuf,
    /// SHA-256 in hexadecimal.
    pub sha256: String,
    /// Its size, if the scene file gives it.
    pub bytes: Option<u64>,
}

impl DataFile {
    /// # Errors
    /// If there is no hash to verify it by, or its URL is not HTTP.
    pub fn new(real: &RealMesh, folder: &Path) -> Result<Self, FetchError> {
        let (url, path) = (real.url.clone(), folder.join(&real.file));
        if real.unpack.is_none() && !["https://", "http://"].iter().any(|scheme| url.starts_with(scheme)) {
            return Err(FetchError::Address { file: real.file.clone(), url });
        }
        match &real.sha256 {
            Some(sha256) if real.unpack.is_none() => {
                Ok(Self { url, path, sha256: sha256.to_lowercase(), bytes: real.bytes })
            }
            _ => Err(FetchError::NoHash {
                file: real.file.clone(),
                url,
                unpack: real.unpack.clone(),
                folder: folder.into(),
            }),
        }
    }

    /// The partial download: in the same folder, so that it can be moved to its path in one step.
    pub fn part(&self) -> PathBuf {
        let name = self.path.file_name().unwrap_or_default().to_string_lossy();
        self.path.with_file_name(format!(".{name}.part"))
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
        match found == self.sha256 {
            true => Ok(true),
            false => Err(FetchError::Other { path: self.path.clone(), found, expected: self.sha256.clone() }),
        }
    }

    /// Moves the finished download to its path if its hash is right; otherwise removes it.
    ///
    /// # Errors
    /// If the hash does not fit, or the system refuses.
    pub fn finish(&self) -> Result<(), FetchError> {
        let part = self.part();
        let refused = |cause: io::Error| FetchError::Write { path: self.path.clone(), cause };
        let found = hash(&part)?;
        if found != self.sha256 {
            fs::remove_file(&part).map_err(refused)?;
            return Err(FetchError::Hash { url: self.url.clone(), found, expected: self.sha256.clone() });
        }
        File::open(&part).and_then(|file| file.sync_all()).map_err(refused)?;
        fs::rename(&part, &self.path).map_err(refused)
    }
}

fn hash(path: &Path) -> Result<String, FetchError> {
    let mut hasher = Sha256::new();
    File::open(path)
        .and_then(|mut file| io::copy(&mut file, &mut hasher))
        .map_err(|cause| FetchError::Read { path: path.into(), cause })?;
    Ok(format!("{:x}", hasher.finalize()))
}
