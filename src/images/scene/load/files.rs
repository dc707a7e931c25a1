//! Reads mesh files and resolves the file names in mesh files.

use std::fs::{self, File};
use std::io::{self, Read as _};
use std::path::{Component, Path, PathBuf};

/// Returns `None` if `name` leads outside `folder`. `name` need not be UTF-8.
///
/// The path below `folder` has no `.` or `..`, because callers compare paths to read each file once.
pub(super) fn named_below(folder: &Path, name: &[u8]) -> Option<PathBuf> {
    #[cfg(unix)]
    let name: &std::ffi::OsStr = std::os::unix::ffi::OsStrExt::from_bytes(name);
    #[cfg(not(unix))]
    let name = &*String::from_utf8_lossy(name);

    let below = Path::new(name).components().try_fold(PathBuf::new(), |mut below, component| match component {
        Component::Normal(part) => Some(below.join(part)),
        Component::CurDir => Some(below),
        Component::ParentDir => below.pop().then_some(below),
        Component::RootDir | Component::Prefix(_) => None,
    });
    below.map(|below| folder.join(below))
}

/// Accepts only regular files, because reading a pipe or a device may block or never end.
pub(super) fn read_start(path: &Path, longest: u64) -> io::Result<Vec<u8>> {
    let file = fs::metadata(path)?;
    if !file.is_file() {
        return Err(io::Error::new(io::ErrorKind::InvalidInput, "it is not a regular file"));
    }
    let mut bytes = Vec::with_capacity(file.len().min(longest) as usize);
    File::open(path)?.take(longest).read_to_end(&mut bytes)?;
    Ok(bytes)
}
