//! Files and folders written whole or not at all.

mod folder;
mod standard;

use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use tempfile::{Builder, NamedTempFile};

use crate::escaped::Escaped as _;

pub use folder::{FolderError, OutputFolder};
pub use standard::{STDOUT, stdout_is_taken};
pub(crate) use standard::{note, print, take_failure, tell, tell_error};

/// A file that results will go to, or standard output where it is called [`STDOUT`].
///
/// It is first written beside its place and then moved there: a reader never sees half of it, and an older file stays
/// when something fails. What is not a regular file (a pipe, `/dev/stdout`) is written to directly.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct OutputFile {
    path: PathBuf,
}

/// Why a file cannot be written.
#[derive(Debug, thiserror::Error)]
pub enum OutputError {
    #[error("cannot write {}: it is a directory: name a file in it", .0.escaped())]
    Directory(PathBuf),
    #[error("cannot write {}: it is one of the files to read: name another one", .0.escaped())]
    Input(PathBuf),
    #[error("cannot write two results to {}: name another file for one of them", .0.escaped())]
    Same(PathBuf),
    #[error("cannot write two results to standard output: name a file for one of them")]
    Twice,
    #[error("cannot write {}: {cause}: choose a place that exists, may be written and has room", path.escaped())]
    Write { path: PathBuf, cause: io::Error },
}

impl OutputFile {
    /// Checks that `path` can be written now, before the long run whose results it is for; leaves nothing behind.
    ///
    /// # Errors
    /// If `path` is a directory, or its directory takes no file; or if another result goes to standard output already.
    pub fn check(path: &Path) -> Result<Self, OutputError> {
        let file = Self { path: path.into() };
        if file.is_stdout() {
            return if standard::take_stdout() { Ok(file) } else { Err(OutputError::Twice) };
        }
        Self::check_place(path)?;
        Ok(file)
    }

    /// The same of the place alone, as often as one likes: standard output is not taken by it.
    ///
    /// # Errors
    /// If `path` is a directory, or its directory takes no file.
    pub fn check_place(path: &Path) -> Result<(), OutputError> {
        let file = Self { path: path.into() };
        match fs::metadata(path) {
            _ if file.is_stdout() => {}
            Ok(there) if there.is_dir() => return Err(OutputError::Directory(path.into())),
            Ok(there) if !there.is_file() => {}
            _ => drop(file.beside().map_err(|cause| file.error(cause))?),
        }
        Ok(())
    }

    /// The same, if it is none of `inputs`, the files that its contents are made from.
    ///
    /// # Errors
    /// If it is one of them, by whatever path.
    pub fn apart_from<'a>(self, inputs: impl IntoIterator<Item = &'a Path>) -> Result<Self, OutputError> {
        if self.is_stdout() {
            return Ok(self);
        }
        let own = self.path.canonicalize().ok().filter(|own| own.is_file());
        let same = |input: &Path| own.is_some() && input.canonicalize().ok() == own;
        if inputs.into_iter().any(same) { Err(OutputError::Input(self.path)) } else { Ok(self) }
    }

    /// Refuses a place that one of the `others` has, too.
    ///
    /// # Errors
    /// If one has, by whatever path.
    pub fn unlike(&self, others: &[&Self]) -> Result<(), OutputError> {
        // A pipe or a terminal takes several; standard output is looked after by [`check`](Self::check).
        let is_special = self.is_stdout() || fs::metadata(&self.path).is_ok_and(|there| !there.is_file());
        let place = |file: &Self| {
            let target = file.target();
            // A file that is not there yet lies in a folder that is.
            Some((folder_of(&target).canonicalize().ok()?, target.file_name()?.to_owned()))
        };
        let own = place(self).filter(|_| !is_special);
        let same = own.is_some() && others.iter().any(|other| place(other) == own);
        if same { Err(OutputError::Same(self.path.clone())) } else { Ok(()) }
    }

    pub fn path(&self) -> &Path {
        &self.path
    }

    fn is_stdout(&self) -> bool {
        self.path == Path::new(STDOUT)
    }

    /// Standard output never fails here: what it has not got is told when the command ends, and a reader that has gone is no error.
    ///
    /// # Errors
    /// If the system refuses, or there is no room; then an older file is as it was.
    pub fn write(&self, bytes: &[u8]) -> Result<(), OutputError> {
        self.place(bytes).map_err(|cause| self.error(cause))
    }

    /// Writes a file that is not there yet, whole; tells whether it was not. Of several writers, also of machines that share a file
    /// system, one wins: what is there stays as it is. When this returns the file is on the disk.
    ///
    /// # Errors
    /// As [`write`](Self::write); then nothing is there.
    pub fn write_new(&self, bytes: &[u8]) -> Result<bool, OutputError> {
        self.place_new(bytes).map_err(|cause| self.error(cause))
    }

    fn place_new(&self, bytes: &[u8]) -> io::Result<bool> {
        match self.written_beside(bytes)?.persist_noclobber(&self.path) {
            Ok(_) => {}
            Err(error) if error.error.kind() == io::ErrorKind::AlreadyExists => return Ok(false),
            Err(error) => return Err(error.error),
        }
        // Makes its name as lasting as its contents, where the system knows how.
        let _ = fs::File::open(folder_of(&self.path)).and_then(|folder| folder.sync_all());
        Ok(true)
    }

    fn place(&self, bytes: &[u8]) -> io::Result<()> {
        if self.is_stdout() {
            print(bytes);
            return Ok(());
        }
        if fs::metadata(&self.path).is_ok_and(|there| !there.is_file()) {
            return standard::unless_gone(fs::OpenOptions::new().write(true).open(&self.path)?.write_all(bytes));
        }
        self.written_beside(bytes)?.persist(self.target())?;
        Ok(())
    }

    /// The file itself, where `path` is a link to it.
    fn target(&self) -> PathBuf {
        self.path.canonicalize().unwrap_or_else(|_| self.path.clone())
    }

    /// A new file in the same directory, with the permissions of any new file.
    fn beside(&self) -> io::Result<NamedTempFile> {
        part(0o666).tempfile_in(folder_of(&self.target()))
    }

    /// The same with `bytes` in it, which are on the disk.
    fn written_beside(&self, bytes: &[u8]) -> io::Result<NamedTempFile> {
        let mut file = self.beside()?;
        file.write_all(bytes)?;
        file.as_file().sync_all()?;
        Ok(file)
    }

    fn error(&self, cause: io::Error) -> OutputError {
        OutputError::Write { path: self.path.clone(), cause: plain(cause) }
    }
}

/// The folder that `path` is in.
fn folder_of(path: &Path) -> &Path {
    path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

/// What makes the files and folders that move to their places when they are whole; where there are permissions, with
/// `mode` less what the system's mask takes.
fn part(#[cfg_attr(not(unix), expect(unused_variables))] mode: u32) -> Builder<'static, 'static> {
    let mut builder = Builder::new();
    builder.prefix(".sahara-").suffix(".part");
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        builder.permissions(fs::Permissions::from_mode(mode));
    }
    builder
}

/// The error of the system itself: tempfile adds the path of a file or folder that the user did not name.
fn plain(error: io::Error) -> io::Error {
    let text = error.to_string();
    match text.split_once(" at path ") {
        Some((cause, _)) => io::Error::new(error.kind(), cause),
        None => error,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(directory: &Path) -> Vec<String> {
        let mut names: Vec<String> =
            fs::read_dir(directory).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        names
    }

    #[test]
    fn a_check_leaves_nothing_and_a_write_leaves_one_file() {
        let directory = tempfile::tempdir().unwrap();
        let file = OutputFile::check(&directory.path().join("a.json")).unwrap();
        assert!(names(directory.path()).is_empty());
        file.write(b"one").unwrap();
        file.write(b"two").unwrap();
        assert_eq!(fs::read(file.path()).unwrap(), b"two");
        assert_eq!(names(directory.path()), ["a.json"]);
    }

    #[test]
    fn a_new_file_replaces_nothing() {
        let directory = tempfile::tempdir().unwrap();
        let file = OutputFile::check(&directory.path().join("a.json")).unwrap();
        assert!(file.write_new(b"one").unwrap() && !file.write_new(b"two").unwrap());
        assert_eq!((fs::read(file.path()).unwrap(), names(directory.path())), (b"one".to_vec(), vec!["a.json".into()]));
    }

    #[test]
    fn what_cannot_be_written_is_found_by_the_check() {
        let directory = tempfile::tempdir().unwrap();
        let error = OutputFile::check(directory.path()).unwrap_err();
        assert!(matches!(error, OutputError::Directory(_)), "{error}");
        let missing = directory.path().join("no/such/a.json");
        let error = OutputFile::check(&missing).unwrap_err().to_string();
        assert!(error.contains("no/such/a.json") && !error.contains(".part"), "{error}");
        let under_a_file = directory.path().join("f");
        fs::write(&under_a_file, b"x").unwrap();
        assert!(OutputFile::check(&under_a_file.join("a.json")).is_err());
    }

    #[test]
    fn standard_output_takes_one_result() {
        assert!(!stdout_is_taken());
        let out = OutputFile::check(Path::new("-")).unwrap().apart_from([Path::new("-")]).unwrap();
        assert!(stdout_is_taken() && out.is_stdout());
        assert!(matches!(OutputFile::check(Path::new("-")), Err(OutputError::Twice)));
        standard::leave_stdout();
    }

    #[test]
    fn what_is_read_is_not_written() {
        let directory = tempfile::tempdir().unwrap();
        let (mesh, other) = (directory.path().join("mesh.obj"), directory.path().join("other.obj"));
        fs::write(&mesh, b"v 0 0 0").unwrap();
        let apart = |path: &Path| OutputFile::check(path).unwrap().apart_from([other.as_path(), &mesh]);
        let detour = directory.path().join("../").join(directory.path().file_name().unwrap()).join("mesh.obj");
        for path in [&mesh, &detour] {
            let error = apart(path).unwrap_err().to_string();
            assert!(error.contains("mesh.obj") && error.contains("another"), "{error}");
        }
        apart(&other).unwrap();
        apart(&directory.path().join("new.obj")).unwrap();
    }

    #[test]
    fn two_results_have_two_places() {
        let directory = tempfile::tempdir().unwrap();
        let file = |name: &str| OutputFile::check(&directory.path().join(name)).unwrap();
        let (one, again, other) = (file("a.json"), file("./a.json"), file("a.csv"));
        other.unlike(&[&one]).unwrap();
        for _ in 0..2 {
            let error = again.unlike(&[&other, &one]).unwrap_err().to_string();
            assert!(error.contains("a.json") && error.contains("two results"), "{error}");
            one.write(b"there").unwrap();
        }
    }

    #[cfg(unix)]
    #[test]
    fn a_link_stays_a_link_and_a_new_file_is_readable_by_others() {
        use std::os::unix::fs::{PermissionsExt, symlink};
        let directory = tempfile::tempdir().unwrap();
        let (real, link) = (directory.path().join("real"), directory.path().join("link"));
        fs::write(&real, b"old").unwrap();
        symlink(&real, &link).unwrap();
        OutputFile::check(&link).unwrap().write(b"new").unwrap();
        assert_eq!(fs::read(&real).unwrap(), b"new");
        assert!(fs::symlink_metadata(&link).unwrap().is_symlink());

        let plain = directory.path().join("plain");
        fs::write(&plain, b"").unwrap();
        let mode = |path: &Path| fs::metadata(path).unwrap().permissions().mode() & 0o777;
        assert_eq!(mode(&real), mode(&plain));
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn a_full_device_is_an_error_and_stays_a_device() {
        let full = Path::new("/dev/full");
        if full.exists() {
            let error = OutputFile::check(full).unwrap().write(b"x").unwrap_err().to_string();
            assert!(error.contains("/dev/full"), "{error}");
            assert!(!fs::metadata(full).unwrap().is_file());
        }
    }
}
