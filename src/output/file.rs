use std::collections::HashSet;
use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::Ordering;

use super::{OutputError, STDOUT, TO_STDOUT, folder_of, print, resolved, temporary_file, unless_gone};

/// A file that results will go to, or standard output where it is called [`STDOUT`]. What is not a regular file (a
/// pipe, `/dev/stdout`) is written to directly.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct OutputFile {
    pub path: PathBuf,
    /// The regular file. Standard output, pipes and terminals have none: they can be read from and written to more than
    /// once.
    regular: Option<PathBuf>,
}

impl OutputFile {
    /// Checks that `path` can be written now, before the long run whose results it is for; leaves nothing behind.
    pub fn check(path: &Path) -> Result<Self, OutputError> {
        let regular = match fs::metadata(path) {
            _ if path == Path::new(STDOUT) => {
                TO_STDOUT.store(true, Ordering::Relaxed);
                None
            }
            Ok(there) if there.is_dir() => {
                return Err(OutputError::place(path, "it is a directory: name a file in it"));
            }
            Ok(there) if !there.is_file() => None,
            _ => {
                let regular = resolved(path).and_then(|regular| temporary_file(&regular).map(|_| regular));
                Some(regular.map_err(|cause| OutputError::write(path, cause))?)
            }
        };
        Ok(Self { path: path.into(), regular })
    }

    /// The same file, if it is none of `inputs`, the files that its contents are made from, by whatever path.
    pub fn apart_from<'a>(self, inputs: impl IntoIterator<Item = &'a Path>) -> Result<Self, OutputError> {
        let is_own = |input: &Path| self.regular.is_some() && input.canonicalize().ok() == self.regular;
        match inputs.into_iter().any(is_own) {
            true => Err(OutputError::place(&self.path, "it is an input file: name another file")),
            false => Ok(self),
        }
    }

    /// Rejects two results for one place, by whatever paths.
    pub fn are_apart<'a>(files: impl IntoIterator<Item = &'a Self>) -> Result<(), OutputError> {
        let mut places = HashSet::new();
        let mut files = files.into_iter().filter(|file| file.regular.is_some() || file.path == Path::new(STDOUT));
        files.find(|file| !places.insert(&file.regular)).map_or(Ok(()), |file| {
            Err(OutputError::place(&file.path, "two results would go there: name another file for one of them"))
        })
    }

    /// Standard output never fails here: what it has not got is told when the command ends, and a reader that has gone
    /// is no error. After any other failed write an older file is as it was.
    pub fn write(&self, bytes: &[u8]) -> Result<(), OutputError> {
        let write = || {
            match &self.regular {
                Some(regular) => drop(written(regular, bytes)?.persist(regular)?),
                None if self.path == Path::new(STDOUT) => print(bytes),
                None => unless_gone(fs::OpenOptions::new().write(true).open(&self.path)?.write_all(bytes))?,
            }
            Ok(())
        };
        write().map_err(|cause| OutputError::write(&self.path, cause))
    }

    /// Writes a file that does not exist yet; false if it does. Of several writers, also on machines that share a file
    /// system, one wins and its file stays as it is. When this returns the file is on the disk; after a failed write there
    /// is none.
    pub fn write_new(&self, bytes: &[u8]) -> Result<bool, OutputError> {
        let Some(regular) = &self.regular else { return Ok(false) };
        match written(regular, bytes).and_then(|file| Ok(file.persist_noclobber(regular)?)) {
            Err(cause) if cause.kind() == io::ErrorKind::AlreadyExists => return Ok(false),
            written => drop(written.map_err(|cause| OutputError::write(&self.path, cause))?),
        }
        // Puts the name on the disk as well as the contents, on systems that can.
        let _ = fs::File::open(folder_of(regular)).and_then(|folder| folder.sync_all());
        Ok(true)
    }
}

/// A new file beside `path` with contents that are on the disk.
fn written(path: &Path, bytes: &[u8]) -> io::Result<tempfile::NamedTempFile> {
    let mut file = temporary_file(path)?;
    file.write_all(bytes)?;
    file.as_file().sync_all()?;
    Ok(file)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_write_leaves_one_whole_file_and_a_check_none() {
        let directory = tempfile::tempdir().unwrap();
        let check = |name: &str| OutputFile::check(&directory.path().join(name));
        let files = || fs::read_dir(directory.path()).unwrap().count();
        let [file, new] = ["a.json", "new.json"].map(|name| check(name).unwrap());
        assert_eq!(files(), 0);
        file.write(b"one").unwrap();
        file.write(b"two").unwrap();
        assert_eq!((fs::read(file.path).unwrap(), files()), (b"two".to_vec(), 1));
        assert!(new.write_new(b"one").unwrap() && !new.write_new(b"two").unwrap());
        assert_eq!((fs::read(new.path).unwrap(), files()), (b"one".to_vec(), 2));
        for (place, part) in [(".", "directory"), ("a.json/b.json", "choose"), ("no/such.json", "no/such.json")] {
            let error = check(place).unwrap_err().to_string();
            assert!(error.contains(part) && !error.contains(".sahara-"), "{error}");
        }
    }

    #[cfg(unix)]
    #[test]
    fn links_stay_links_and_new_files_are_readable_by_others() {
        use std::os::unix::fs::{PermissionsExt, symlink};
        let directory = tempfile::tempdir().unwrap();
        let [real, link, plain] = ["real", "link", "plain"].map(|name| directory.path().join(name));
        fs::write(&real, b"old").unwrap();
        fs::write(&plain, b"").unwrap();
        symlink(&real, &link).unwrap();
        OutputFile::check(&link).unwrap().write(b"new").unwrap();
        assert!(fs::symlink_metadata(&link).unwrap().is_symlink() && fs::read(&real).unwrap() == b"new");
        let mode = |path: &Path| fs::metadata(path).unwrap().permissions().mode() & 0o777;
        assert_eq!(mode(&real), mode(&plain));
    }
}
