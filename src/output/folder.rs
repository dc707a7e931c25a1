use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use tempfile::TempDir;

use super::{OutputError, folder_of, resolved, temporary};
use crate::escaped::Escaped as _;

/// The file that marks a folder as written by sahara: it lists the folder's files.
const MARK: &str = "sahara-files.json";

/// A folder that results will go to; all its contents are sahara's.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct OutputFolder {
    pub path: PathBuf,
    resolved: PathBuf,
}

impl OutputFolder {
    /// Checks that `path` may be written: it does not exist, is empty or holds only what was written there before.
    /// Leaves nothing behind.
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
        folder.temporary().map_err(failed)?;
        Ok(folder)
    }

    /// The same folder, if none of `inputs`, the files that its contents are made from, is in it, by whatever path.
    pub fn apart_from<'a>(self, inputs: impl IntoIterator<Item = &'a Path>) -> Result<Self, OutputError> {
        let is_inside = |input: &&Path| input.canonicalize().is_ok_and(|input| input.starts_with(&self.resolved));
        match inputs.into_iter().find(is_inside) {
            Some(input) => {
                let problem = format!("it contains {}, an input file: name another folder", input.escaped());
                Err(OutputError::place(&self.path, problem))
            }
            None => Ok(self),
        }
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
        let replace = || {
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
        };
        replace().map_err(|cause| OutputError::write(&self.path, cause))
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
