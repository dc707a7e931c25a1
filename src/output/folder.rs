use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use tempfile::TempDir;

use super::{OutputError, folder_of, resolved, temporary};

/// The file that marks a folder as written by sahara: it lists the folder's files.
const MARK: &str = "sahara-files.json";

/// A folder that results will go to; all its contents are sahara's.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct OutputFolder {
    path: PathBuf,
    resolved: PathBuf,
}

impl OutputFolder {
    /// Checks that `path` may be written: it does not exist, is empty or holds only what was written there before.
    /// Leaves nothing behind.
    pub fn check(path: &Path) -> Result<Self, OutputError> {
        if path.exists() && !path.is_dir() {
            return Err(OutputError::File(path.into()));
        }
        let failed = |cause| OutputError::write(path, cause);
        let folder = Self { path: path.into(), resolved: resolved(path).map_err(failed)? };
        if let Some(other) = folder.foreign().map_err(failed)? {
            return Err(OutputError::Foreign { path: path.into(), other });
        }
        folder.temporary().map_err(failed)?;
        Ok(folder)
    }

    /// The same folder, if none of `inputs`, the files that its contents are made from, is in it, by whatever path.
    pub fn apart_from<'a>(self, inputs: impl IntoIterator<Item = &'a Path>) -> Result<Self, OutputError> {
        let is_inside = |input: &&Path| input.canonicalize().is_ok_and(|input| input.starts_with(&self.resolved));
        match inputs.into_iter().find(is_inside) {
            Some(input) => Err(OutputError::InputInside { path: self.path, input: input.into() }),
            None => Ok(self),
        }
    }

    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Writes files, given by their paths in the folder with `/`, in place of what was there, which stays as it was if
    /// that fails.
    pub fn write(&self, files: &[(String, Vec<u8>)]) -> Result<(), OutputError> {
        self.write_in(|folder| {
            files.iter().try_for_each(|(name, bytes)| {
                let path = folder.join(name);
                fs::create_dir_all(folder_of(&path))?;
                fs::write(path, bytes)
            })
        })
    }

    /// As [`write`](Self::write), of files that `fill` writes one by one into the folder that it is given: they may be more
    /// than memory takes.
    pub fn write_in<T>(&self, fill: impl FnOnce(&Path) -> io::Result<T>) -> Result<T, OutputError> {
        self.replace(fill).map_err(|cause| OutputError::write(&self.path, cause))
    }

    fn replace<T>(&self, fill: impl FnOnce(&Path) -> io::Result<T>) -> io::Result<T> {
        let new = self.temporary()?;
        let filled = fill(new.path())?;
        let mut names = names_below(new.path(), "")?;
        names.push(MARK.into());
        fs::write(new.path().join(MARK), serde_json::to_vec_pretty(&names).expect("names are text"))?;

        // Move the old folder aside, and back if the new one cannot take its place.
        let aside = self.temporary()?;
        let old = aside.path().join("old");
        if self.resolved.exists() {
            fs::rename(&self.resolved, &old)?;
        }
        fs::rename(new.path(), &self.resolved).inspect_err(|_| drop(fs::rename(&old, &self.resolved)))?;
        // It has moved: nothing is left to remove.
        let _ = new.keep();
        Ok(filled)
    }

    /// The first name in the folder that is not on its list.
    fn foreign(&self) -> io::Result<Option<String>> {
        if !self.resolved.exists() {
            return Ok(None);
        }
        let mark = fs::read(self.resolved.join(MARK)).unwrap_or_default();
        let listed: Vec<String> = serde_json::from_slice(&mark).unwrap_or_default();
        Ok(names_below(&self.resolved, "")?.into_iter().filter(|name| !listed.contains(name)).min())
    }

    /// A new folder beside this one; it is removed when it is dropped.
    fn temporary(&self) -> io::Result<TempDir> {
        temporary(0o777).tempdir_in(folder_of(&self.resolved))
    }
}

/// All files below `folder` by their paths in it, with `/`, and the folders that are empty.
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn earlier_results_are_replaced_and_what_others_wrote_stays() {
        let parent = tempfile::tempdir().unwrap();
        let path = parent.path().join("out");
        let count = |folder: &Path| fs::read_dir(folder).unwrap().count();
        // An empty folder is taken. Files that the new one does not have are gone with the old one.
        fs::create_dir(&path).unwrap();
        for names in [&["index.html", "data/a.csv"][..], &["index.html", "data/a.csv"], &["data/b.csv"]] {
            let files: Vec<_> = names.iter().map(|name| (name.to_string(), b"text".to_vec())).collect();
            OutputFolder::check(&path).unwrap().write(&files).unwrap();
            assert!(names.iter().all(|name| fs::read(path.join(name)).unwrap() == b"text"));
            assert_eq!([count(parent.path()), count(&path)], [1, names.len() + 1]);
        }

        for name in ["notes.txt", "data/notes.txt"] {
            fs::write(path.join(name), "mine").unwrap();
            let error = OutputFolder::check(&path).unwrap_err().to_string();
            assert!(error.contains(name) && error.contains("another folder"), "{error}");
            fs::remove_file(path.join(name)).unwrap();
        }
        fs::create_dir(path.join("empty")).unwrap();
        assert!(matches!(OutputFolder::check(&path), Err(OutputError::Foreign { .. })));
        let file = parent.path().join("file");
        fs::write(&file, "mine").unwrap();
        assert!(matches!(OutputFolder::check(&file), Err(OutputError::File(_))));
        for nowhere in [file.join("x"), parent.path().join("no/such")] {
            assert!(matches!(OutputFolder::check(&nowhere), Err(OutputError::Write { .. })));
        }
    }
}
