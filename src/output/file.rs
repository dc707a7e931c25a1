use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use tempfile::NamedTempFile;

use super::standard::{STDOUT, print, take_stdout, unless_gone};
use super::{OutputError, folder_of, target, temporary};

/// A file that results will go to, or standard output where it is called [`STDOUT`]. What is not a regular file (a
/// pipe, `/dev/stdout`) is written to directly.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct OutputFile {
    path: PathBuf,
}

impl OutputFile {
    /// Checks that `path` can be written now, before the long run whose results it is for; leaves nothing behind.
    /// Standard output takes one result.
    pub fn check(path: &Path) -> Result<Self, OutputError> {
        Self::check_place(path)?;
        let file = Self { path: path.into() };
        if file.is_stdout() && !take_stdout() { Err(OutputError::Twice) } else { Ok(file) }
    }

    /// Checks the place alone, as often as one likes: standard output is not taken by it.
    pub fn check_place(path: &Path) -> Result<(), OutputError> {
        let file = Self { path: path.into() };
        match fs::metadata(path) {
            _ if file.is_stdout() => {}
            Ok(there) if there.is_dir() => return Err(OutputError::Directory(path.into())),
            Ok(there) if !there.is_file() => {}
            _ => drop(file.temporary().map_err(|cause| OutputError::write(path, cause))?),
        }
        Ok(())
    }

    /// The same file, if it is none of `inputs`, the files that its contents are made from, by whatever path.
    pub fn apart_from<'a>(self, inputs: impl IntoIterator<Item = &'a Path>) -> Result<Self, OutputError> {
        let own = self.identity();
        let is_input = own.is_some() && inputs.into_iter().any(|input| input.canonicalize().ok() == own);
        if is_input { Err(OutputError::Input(self.path)) } else { Ok(self) }
    }

    /// Rejects a file that is also one of the `others`, by whatever path.
    pub fn unlike(&self, others: &[&Self]) -> Result<(), OutputError> {
        let own = self.identity();
        let is_same = own.is_some() && others.iter().any(|other| other.identity() == own);
        if is_same { Err(OutputError::Same(self.path.clone())) } else { Ok(()) }
    }

    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Standard output never fails here: what it has not got is told when the command ends, and a reader that has gone
    /// is no error. After any other failed write an older file is as it was.
    pub fn write(&self, bytes: &[u8]) -> Result<(), OutputError> {
        let write = || {
            if self.is_stdout() {
                print(bytes);
                return Ok(());
            }
            if self.is_special() {
                return unless_gone(fs::OpenOptions::new().write(true).open(&self.path)?.write_all(bytes));
            }
            self.temporary_with(bytes)?.persist(target(&self.path))?;
            Ok(())
        };
        write().map_err(|cause| OutputError::write(&self.path, cause))
    }

    /// Writes a file that does not exist yet; false if it does. Of several writers, also on machines that share a file
    /// system, one wins and its file stays as it is. When this returns the file is on the disk; after a failed write there
    /// is none.
    pub fn write_new(&self, bytes: &[u8]) -> Result<bool, OutputError> {
        let failed = |cause| OutputError::write(&self.path, cause);
        match self.temporary_with(bytes).map_err(failed)?.persist_noclobber(&self.path) {
            Err(refused) if refused.error.kind() == io::ErrorKind::AlreadyExists => return Ok(false),
            written => drop(written.map_err(|refused| failed(refused.error))?),
        }
        // Puts the name on the disk as well as the contents, on systems that can.
        let _ = fs::File::open(folder_of(&self.path)).and_then(|folder| folder.sync_all());
        Ok(true)
    }

    fn is_stdout(&self) -> bool {
        self.path == Path::new(STDOUT)
    }

    fn is_special(&self) -> bool {
        fs::metadata(&self.path).is_ok_and(|there| !there.is_file())
    }

    /// The one path that a regular file has, whether it exists yet or not. Standard output, pipes and terminals have
    /// none: they can be read from and written to more than once.
    fn identity(&self) -> Option<PathBuf> {
        if self.is_stdout() || self.is_special() {
            return None;
        }
        let new = || Some(folder_of(&self.path).canonicalize().ok()?.join(self.path.file_name()?));
        self.path.canonicalize().ok().or_else(new)
    }

    fn temporary(&self) -> io::Result<NamedTempFile> {
        temporary(0o666).tempfile_in(folder_of(&target(&self.path)))
    }

    fn temporary_with(&self, bytes: &[u8]) -> io::Result<NamedTempFile> {
        let mut file = self.temporary()?;
        file.write_all(bytes)?;
        file.as_file().sync_all()?;
        Ok(file)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::output::standard::{leave_stdout, stdout_is_taken};

    fn check(directory: &tempfile::TempDir, name: &str) -> Result<OutputFile, OutputError> {
        OutputFile::check(&directory.path().join(name))
    }

    #[test]
    fn a_write_leaves_one_whole_file_and_a_check_none() {
        let directory = tempfile::tempdir().unwrap();
        let files = || fs::read_dir(directory.path()).unwrap().count();
        let (file, new) = (check(&directory, "a.json").unwrap(), check(&directory, "new.json").unwrap());
        assert_eq!(files(), 0);
        file.write(b"one").unwrap();
        file.write(b"two").unwrap();
        assert_eq!((fs::read(file.path()).unwrap(), files()), (b"two".to_vec(), 1));
        assert!(new.write_new(b"one").unwrap() && !new.write_new(b"two").unwrap());
        assert_eq!((fs::read(new.path()).unwrap(), files()), (b"one".to_vec(), 2));
    }

    #[test]
    fn places_that_cannot_be_written_are_found_by_the_check() {
        let directory = tempfile::tempdir().unwrap();
        fs::write(directory.path().join("f"), b"x").unwrap();
        assert!(matches!(check(&directory, "."), Err(OutputError::Directory(_))));
        assert!(matches!(check(&directory, "f/a.json"), Err(OutputError::Write { .. })));
        let error = check(&directory, "no/such/a.json").unwrap_err().to_string();
        assert!(error.contains("no/such/a.json") && !error.contains(".part"), "{error}");
    }

    #[test]
    fn standard_output_takes_one_result() {
        let check = || OutputFile::check(Path::new(STDOUT));
        assert!(!stdout_is_taken());
        let out = check().unwrap().apart_from([Path::new(STDOUT)]).unwrap();
        assert!(stdout_is_taken() && out.unlike(&[&out]).is_ok());
        assert!(matches!(check(), Err(OutputError::Twice)));
        leave_stdout();
    }

    #[cfg(unix)]
    #[test]
    fn links_stay_links_devices_stay_devices_and_new_files_are_readable_by_others() {
        use std::os::unix::fs::{PermissionsExt, symlink};
        let directory = tempfile::tempdir().unwrap();
        let [real, link, plain] = ["real", "link", "plain"].map(|name| directory.path().join(name));
        fs::write(&real, b"old").unwrap();
        fs::write(&plain, b"").unwrap();
        symlink(&real, &link).unwrap();
        check(&directory, "link").unwrap().write(b"new").unwrap();
        assert_eq!(fs::read(&real).unwrap(), b"new");
        assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
        let mode = |path: &Path| fs::metadata(path).unwrap().permissions().mode() & 0o777;
        assert_eq!(mode(&real), mode(&plain));

        let full = Path::new("/dev/full");
        if full.exists() {
            let error = OutputFile::check(full).unwrap().write(b"x").unwrap_err().to_string();
            assert!(error.contains("/dev/full"), "{error}");
            assert!(!fs::metadata(full).unwrap().is_file());
        }
    }
}
