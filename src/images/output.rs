//! Writes results to files, folders and standard output.
//!
//! A regular file or a folder is first written under a temporary name beside the target. The complete file or folder
//! is then renamed to the target. A failed write keeps the old contents of the target.
//!
//! A reader that closes standard output, such as `head`, causes no error.

use std::collections::HashSet;
use std::fmt::Display;
use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::OnceLock;
use std::sync::atomic::{AtomicBool, Ordering};

use tempfile::{Builder, NamedTempFile, TempDir};

use crate::escaped::Escaped as _;

/// The file name for standard output.
pub const STDOUT: &str = "-";

/// The name of the file that lists the contents of an output folder. [`OutputFolder::check`] rejects unlisted files.
const MARK: &str = "sahara-files.json";

#[derive(Debug, thiserror::Error)]
pub enum OutputError {
    #[error("cannot write {}: {problem}", path.escaped())]
    Target { path: PathBuf, problem: String },
    #[error("cannot write {}: {cause}: choose an existing, writable folder with free space", path.escaped())]
    Write { path: PathBuf, cause: io::Error },
}

impl OutputError {
    fn place(path: &Path, problem: impl Into<String>) -> Self {
        Self::Target { path: path.into(), problem: problem.into() }
    }

    /// Keeps only the kind of a custom error, because errors of `tempfile` contain temporary paths.
    fn write(path: &Path, error: io::Error) -> Self {
        let cause = if error.get_ref().is_some() { error.kind().into() } else { error };
        Self::Write { path: path.into(), cause }
    }
}

/// A destination of results. The path [`STDOUT`] represents standard output.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct OutputFile {
    pub path: PathBuf,
    /// The path of the regular file, without symbolic links. `None` for standard output and special files, such as
    /// pipes.
    regular: Option<PathBuf>,
}

impl OutputFile {
    /// Checks that results can be written to `path`. Leaves no file behind.
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

    pub fn apart_from<'a>(self, inputs: impl IntoIterator<Item = &'a Path>) -> Result<Self, OutputError> {
        let is_own = |input: &Path| self.regular.is_some() && input.canonicalize().ok() == self.regular;
        if inputs.into_iter().any(is_own) {
            return Err(OutputError::place(&self.path, "it is an input file: name another file"));
        }
        Ok(self)
    }

    pub fn are_apart<'a>(files: impl IntoIterator<Item = &'a Self>) -> Result<(), OutputError> {
        let mut places = HashSet::new();
        let mut files = files.into_iter().filter(|file| file.regular.is_some() || file.path == Path::new(STDOUT));
        let Some(twice) = files.find(|file| !places.insert(&file.regular)) else { return Ok(()) };
        Err(OutputError::place(&twice.path, "two results would go there: name another file for one of them"))
    }

    /// Stores an error of standard output in [`FAILURE`], instead of returning the error.
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

    /// Returns false if the path exists or is [`STDOUT`]. Only one of several concurrent calls for one path
    /// returns true, even on machines that share a file system. The contents are flushed to the disk.
    pub fn write_new(&self, bytes: &[u8]) -> Result<bool, OutputError> {
        let Some(regular) = &self.regular else { return Ok(false) };
        match written(regular, bytes).and_then(|file| Ok(file.persist_noclobber(regular)?)) {
            Err(cause) if cause.kind() == io::ErrorKind::AlreadyExists => return Ok(false),
            written => drop(written.map_err(|cause| OutputError::write(&self.path, cause))?),
        }
        // The folder is flushed, because the folder stores the name of the file. Errors are ignored, because some
        // systems cannot flush folders.
        let _ = fs::File::open(folder_of(regular)).and_then(|folder| folder.sync_all());
        Ok(true)
    }
}

fn written(path: &Path, bytes: &[u8]) -> io::Result<NamedTempFile> {
    let mut file = temporary_file(path)?;
    file.write_all(bytes)?;
    file.as_file().sync_all()?;
    Ok(file)
}

/// A folder that contains only output of sahara.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct OutputFolder {
    pub path: PathBuf,
    resolved: PathBuf,
}

impl OutputFolder {
    /// Checks that the folder contains only earlier output of sahara. The folder may be empty or missing. Leaves no
    /// file behind.
    pub fn check(path: &Path) -> Result<Self, OutputError> {
        if path.exists() && !path.is_dir() {
            return Err(OutputError::place(path, "it is a file: name a folder that does not exist yet"));
        }
        let failed = |cause| OutputError::write(path, cause);
        let folder = Self { path: path.into(), resolved: resolved(path).map_err(failed)? };
        let mark = fs::read(path.join(MARK)).unwrap_or_default();
        let listed: Vec<String> = serde_json::from_slice(&mark).unwrap_or_default();
        let names = if path.exists() { names_below(path, "").map_err(failed)? } else { vec![] };
        if let Some(other) = names.iter().filter(|name| !listed.contains(name)).min() {
            let problem = format!("it contains {other}, which sahara did not write: name another folder, or empty it");
            return Err(OutputError::place(path, problem));
        }
        temporary_folder(&folder.resolved).map_err(failed)?;
        Ok(folder)
    }

    pub fn apart_from<'a>(self, inputs: impl IntoIterator<Item = &'a Path>) -> Result<Self, OutputError> {
        let is_inside = |input: &&Path| input.canonicalize().is_ok_and(|input| input.starts_with(&self.resolved));
        let Some(input) = inputs.into_iter().find(is_inside) else { return Ok(self) };
        let problem = format!("it contains {}, an input file: name another folder", input.escaped());
        Err(OutputError::place(&self.path, problem))
    }

    /// Replaces the contents of the folder with `files`. Each name is a relative path with `/` as separator.
    pub fn write(&self, files: &[(String, Vec<u8>)]) -> Result<(), OutputError> {
        self.write_in(|folder| {
            files.iter().try_for_each(|(name, bytes)| {
                let path = folder.join(name);
                fs::create_dir_all(folder_of(&path))?;
                fs::write(path, bytes)
            })
        })
    }

    /// `fill` receives the path of a temporary folder for the new files.
    pub fn write_in<T>(&self, fill: impl FnOnce(&Path) -> io::Result<T>) -> Result<T, OutputError> {
        let replace = || {
            let new = temporary_folder(&self.resolved)?;
            let filled = fill(new.path())?;
            let mut names = names_below(new.path(), "")?;
            names.push(MARK.into());
            fs::write(new.path().join(MARK), serde_json::to_vec_pretty(&names).expect("names are text"))?;

            let aside = temporary_folder(&self.resolved)?;
            let old = aside.path().join("old");
            if self.resolved.exists() {
                fs::rename(&self.resolved, &old)?;
            }
            fs::rename(new.path(), &self.resolved).inspect_err(|_| drop(fs::rename(&old, &self.resolved)))?;
            // `keep` prevents the destructor of `new` from deleting the temporary path.
            let _ = new.keep();
            Ok(filled)
        };
        replace().map_err(|cause| OutputError::write(&self.path, cause))
    }
}

/// The files and empty folders below `folder`, as relative paths with `/` as separator.
fn names_below(folder: &Path, prefix: &str) -> io::Result<Vec<String>> {
    let mut names = vec![];
    for entry in fs::read_dir(folder)? {
        let entry = entry?;
        let name = format!("{prefix}{}", entry.file_name().to_string_lossy());
        let is_folder = entry.file_type()?.is_dir();
        let below = if is_folder { names_below(&entry.path(), &format!("{name}/"))? } else { vec![] };
        if below.is_empty() { names.push(name) } else { names.extend(below) }
    }
    Ok(names)
}

/// The absolute path, without symbolic links. The file may be missing. The parent folder must exist.
fn resolved(path: &Path) -> io::Result<PathBuf> {
    path.canonicalize().or_else(|missing| {
        let (Some(folder), Some(name)) = (path.parent(), path.file_name()) else { return Err(missing) };
        Ok(Path::new(".").join(folder).canonicalize()?.join(name))
    })
}

fn folder_of(path: &Path) -> &Path {
    path.parent().unwrap_or(path)
}

pub fn temporary_file(path: &Path) -> io::Result<NamedTempFile> {
    temporary(0o666).tempfile_in(folder_of(path))
}

fn temporary_folder(path: &Path) -> io::Result<TempDir> {
    temporary(0o777).tempdir_in(folder_of(path))
}

/// On Unix, the permissions of the temporary file or folder are `mode` without the bits of the umask.
fn temporary(#[cfg_attr(not(unix), expect(unused_variables))] mode: u32) -> Builder<'static, 'static> {
    let mut builder = Builder::new();
    builder.prefix(".sahara-");
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(mode));
    builder
}

static TO_STDOUT: AtomicBool = AtomicBool::new(false);

/// The first error from a write to standard output. A broken pipe is not recorded. The command reports the error when
/// it ends.
pub static FAILURE: OnceLock<io::Error> = OnceLock::new();

/// Whether a result is written to standard output. If so, callers print messages to standard error.
pub fn stdout_is_taken() -> bool {
    TO_STDOUT.load(Ordering::Relaxed)
}

pub fn print(bytes: &[u8]) {
    let mut out = io::stdout().lock();
    record_failure(out.write_all(bytes).and_then(|()| out.flush()));
}

pub fn record_failure(written: io::Result<()>) {
    if let Err(cause) = unless_gone(written) {
        FAILURE.get_or_init(|| cause);
    }
}

fn unless_gone(written: io::Result<()>) -> io::Result<()> {
    match written {
        Err(cause) if cause.kind() == io::ErrorKind::BrokenPipe => Ok(()),
        written => written,
    }
}

/// Prints the error on one line. Control characters in the text are escaped.
pub fn print_error(error: impl Display) {
    print_to_stderr(format_args!("error: {}", error.to_string().escaped()));
}

pub fn print_to_stderr(line: impl Display) {
    let _ = writeln!(io::stderr(), "{line}");
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

    #[test]
    fn earlier_results_are_replaced_and_what_others_wrote_stays() {
        let parent = tempfile::tempdir().unwrap();
        let path = parent.path().join("out");
        fs::create_dir(&path).unwrap();
        for names in [&["index.html", "data/a.csv"][..], &["data/b.csv"]] {
            let files: Vec<_> = names.iter().map(|name| (name.to_string(), b"text".to_vec())).collect();
            OutputFolder::check(&path).unwrap().write(&files).unwrap();
            assert_eq!(fs::read_dir(parent.path()).unwrap().count(), 1);
            assert_eq!(names_below(&path, "").unwrap().len(), names.len() + 1, "files of before are gone");
        }
        for other in ["notes.txt", "data/empty"] {
            fs::create_dir(path.join(other)).unwrap();
            assert!(OutputFolder::check(&path).unwrap_err().to_string().contains(&format!("{other}, which")));
            fs::remove_dir(path.join(other)).unwrap();
        }
    }
}
