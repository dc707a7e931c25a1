//! A folder written whole or not at all.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use super::{folder_of, part, plain};

use crate::escaped::Escaped as _;

/// The file that tells a folder of ours from others: it lists what is in it.
const MARK: &str = "sahara-files.json";

/// A folder that results will go to; everything in it is ours.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct OutputFolder {
    path: PathBuf,
}

/// Why a folder cannot be written.
#[derive(Debug, thiserror::Error)]
pub enum FolderError {
    #[error("{} is a file: name a folder that does not exist yet", .0.escaped())]
    File(PathBuf),
    #[error("{} holds something that sahara has not written there, {other}: name another folder, or empty it", path.escaped())]
    Foreign { path: PathBuf, other: String },
    #[error("cannot replace {}: {}, one of the files to read, is in it: name another folder", path.escaped(), input.escaped())]
    Input { path: PathBuf, input: PathBuf },
    #[error("cannot write {}: {cause}: choose a place that exists, may be written and has room", path.escaped())]
    Write { path: PathBuf, cause: io::Error },
}

impl OutputFolder {
    /// Checks that `path` may be written: it does not exist, is empty or holds what was written there before and
    /// nothing else. Leaves nothing behind.
    ///
    /// # Errors
    /// If it is a file, holds anything else, or its parent takes no folder.
    pub fn check(path: &Path) -> Result<Self, FolderError> {
        let folder = Self { path: path.into() };
        if path.exists() && !path.is_dir() {
            return Err(FolderError::File(path.into()));
        }
        if let Some(other) = folder.foreign().map_err(|cause| folder.error(cause))? {
            return Err(FolderError::Foreign { path: path.into(), other });
        }
        folder.beside().map_err(|cause| folder.error(cause))?;
        Ok(folder)
    }

    /// The same, if none of `inputs`, the files that its contents are made from, is in it.
    ///
    /// # Errors
    /// If one is, by whatever path.
    pub fn apart_from<'a>(self, inputs: impl IntoIterator<Item = &'a Path>) -> Result<Self, FolderError> {
        let own = self.path.canonicalize().ok();
        let inside = |input: &Path| {
            own.as_ref().is_some_and(|own| input.canonicalize().is_ok_and(|input| input.starts_with(own)))
        };
        match inputs.into_iter().find(|input| inside(input)) {
            Some(input) => Err(FolderError::Input { path: self.path, input: input.into() }),
            None => Ok(self),
        }
    }

    /// The name of anything in the folder that is not on its list.
    fn foreign(&self) -> io::Result<Option<String>> {
        if !self.path.exists() {
            return Ok(None);
        }
        let listed: Vec<String> = match fs::read(self.path.join(MARK)) {
            Ok(mark) => serde_json::from_slice(&mark).unwrap_or_default(),
            Err(cause) if cause.kind() == io::ErrorKind::NotFound => vec![],
            Err(cause) => return Err(cause),
        };
        let mut found = vec![];
        names(&self.path, "", &mut found)?;
        Ok(found.into_iter().find(|name| !listed.contains(name)))
    }

    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Writes files by their paths in the folder, with `/`, in place of what was there.
    ///
    /// # Errors
    /// If the system refuses, or there is no room; then what was there before is as it was.
    pub fn write(&self, files: &[(String, Vec<u8>)]) -> Result<(), FolderError> {
        self.place(files).map_err(|cause| self.error(cause))
    }

    fn place(&self, files: &[(String, Vec<u8>)]) -> io::Result<()> {
        let new = self.beside()?;
        let mut listed: Vec<&str> = files.iter().map(|(name, _)| name.as_str()).collect();
        listed.push(MARK);
        let mark = serde_json::to_vec_pretty(&listed).expect("names are text");
        for (name, bytes) in files.iter().map(|(name, bytes)| (name.as_str(), bytes)).chain([(MARK, &mark)]) {
            let path = new.path().join(name);
            fs::create_dir_all(path.parent().expect("it is in the folder"))?;
            fs::write(path, bytes)?;
        }

        // An old folder moves aside, and back when the new one cannot take its place.
        let target = self.target();
        if !target.exists() {
            return fs::rename(new.keep(), &target);
        }
        let aside = self.beside()?;
        let old = aside.path().join("old");
        fs::rename(&target, &old)?;
        fs::rename(new.path(), &target).inspect_err(|_| {
            let _ = fs::rename(&old, &target);
        })?;
        // It is under another name now: nothing is left to remove.
        let _ = new.keep();
        Ok(())
    }

    /// A new folder in the same directory, with the permissions of any new folder; it goes when it is dropped.
    fn beside(&self) -> io::Result<tempfile::TempDir> {
        part(0o777).tempdir_in(folder_of(&self.target()))
    }

    /// The folder itself, where `path` is a link to it.
    fn target(&self) -> PathBuf {
        self.path.canonicalize().unwrap_or_else(|_| self.path.clone())
    }

    fn error(&self, cause: io::Error) -> FolderError {
        FolderError::Write { path: self.path.clone(), cause: plain(cause) }
    }
}

/// All files below `folder`, with `/`; empty folders by their name.
fn names(folder: &Path, prefix: &str, found: &mut Vec<String>) -> io::Result<()> {
    let mut entries: Vec<fs::DirEntry> = fs::read_dir(folder)?.collect::<io::Result<_>>()?;
    entries.sort_by_key(fs::DirEntry::file_name);
    for entry in entries {
        let name = format!("{prefix}{}", entry.file_name().to_string_lossy());
        if entry.file_type()?.is_dir() {
            let before = found.len();
            names(&entry.path(), &format!("{name}/"), found)?;
            if found.len() == before {
                found.push(name);
            }
        } else {
            found.push(name);
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn files(text: &str) -> Vec<(String, Vec<u8>)> {
        ["index.html", "data/a.csv"].map(|name| (name.to_owned(), text.as_bytes().to_vec())).into()
    }

    fn entries(folder: &Path) -> usize {
        fs::read_dir(folder).unwrap().count()
    }

    #[test]
    fn what_is_ours_is_replaced_and_nothing_is_left_beside() {
        let parent = tempfile::tempdir().unwrap();
        let path = parent.path().join("out");
        for text in ["one", "two"] {
            OutputFolder::check(&path).unwrap().write(&files(text)).unwrap();
            assert_eq!(fs::read_to_string(path.join("data/a.csv")).unwrap(), text);
            assert_eq!(entries(parent.path()), 1);
        }
        // What the new one does not have is gone with the old one.
        OutputFolder::check(&path).unwrap().write(&files("three")[..1]).unwrap();
        assert!(!path.join("data").exists());
    }

    #[test]
    fn what_is_not_ours_stays() {
        let parent = tempfile::tempdir().unwrap();
        let path = parent.path().join("out");
        OutputFolder::check(&path).unwrap().write(&files("one")).unwrap();
        for name in ["notes.txt", "data/notes.txt"] {
            fs::write(path.join(name), "mine").unwrap();
            let error = OutputFolder::check(&path).unwrap_err().to_string();
            assert!(error.contains(name) && error.contains("another folder"), "{error}");
            fs::remove_file(path.join(name)).unwrap();
        }
        fs::create_dir(path.join("empty")).unwrap();
        assert!(OutputFolder::check(&path).is_err());
        let file = parent.path().join("file");
        fs::write(&file, "mine").unwrap();
        assert!(matches!(OutputFolder::check(&file), Err(FolderError::File(_))));
        assert!(matches!(OutputFolder::check(&file.join("x")), Err(FolderError::Write { .. })));
        assert!(matches!(OutputFolder::check(&parent.path().join("no/such")), Err(FolderError::Write { .. })));
    }

    #[test]
    fn what_is_read_is_not_replaced() {
        let parent = tempfile::tempdir().unwrap();
        let path = parent.path().join("out");
        let folder = OutputFolder::check(&path).unwrap();
        folder.write(&files("one")).unwrap();
        let (inside, beside) = (path.join("../out/data/a.csv"), parent.path().join("a.csv"));
        fs::write(&beside, "mine").unwrap();
        let error = folder.clone().apart_from([beside.as_path(), &inside]).unwrap_err().to_string();
        assert!(error.contains("a.csv, one of the files to read") && error.contains("another folder"), "{error}");
        folder.apart_from([beside.as_path(), &parent.path().join("not-there")]).unwrap();
    }

    #[test]
    fn an_empty_folder_is_taken() {
        let parent = tempfile::tempdir().unwrap();
        OutputFolder::check(parent.path()).unwrap().write(&files("one")).unwrap();
        assert_eq!(entries(parent.path()), 3);
    }
}
