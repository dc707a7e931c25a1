//! The identity and the start time of the running program.

use std::fs::File;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;
use std::time::SystemTime;

use sha2::{Digest, Sha256};

/// The first 16 hexadecimal digits of the SHA-256 of the executable file.
pub fn build() -> &'static str {
    static BUILD: OnceLock<String> = OnceLock::new();
    BUILD.get_or_init(|| file_id(&executable()).unwrap_or_else(|_| "unknown".into()))
}

/// On Linux, the path remains valid after the file is replaced or deleted.
pub fn executable() -> PathBuf {
    let kept = Path::new("/proc/self/exe");
    if kept.exists() { kept.into() } else { std::env::current_exe().unwrap_or_default() }
}

pub fn digest(bytes: &[u8]) -> String {
    format!("{:x}", Sha256::digest(bytes))
}

/// # Errors
/// If the file cannot be read.
pub fn file_id(path: &Path) -> io::Result<String> {
    file_sha256(path).map(|digits| digits[..16].to_owned())
}

/// # Errors
/// If the file cannot be read.
pub fn file_sha256(path: &Path) -> io::Result<String> {
    let mut hasher = Sha256::new();
    io::copy(&mut File::open(path)?, &mut hasher)?;
    Ok(format!("{:x}", hasher.finalize()))
}

/// The time of the first call of this function, in UTC, such as `2026-03-01T12:30:59Z`.
pub fn started() -> &'static str {
    static STARTED: OnceLock<String> = OnceLock::new();
    STARTED.get_or_init(|| humantime::format_rfc3339_seconds(SystemTime::now()).to_string())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_is_known_by_its_bytes() {
        let folder = tempfile::tempdir().unwrap();
        let write = |name: &str, bytes: &[u8]| {
            let path = folder.path().join(name);
            std::fs::write(&path, bytes).unwrap();
            file_id(&path).unwrap()
        };
        assert_eq!(write("a", b"abc"), "ba7816bf8f01cfea");
        assert_eq!(write("b", b"abc"), write("a", b"abc"));
        assert_ne!(write("a", b"abd"), write("b", b"abc"));
        assert!(file_id(&folder.path().join("none")).is_err());
        assert_ne!(build(), "unknown");
    }
}
