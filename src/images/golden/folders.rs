//! Pictures of two folders, by their names.

use std::collections::BTreeSet;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

/// Extensions of pictures. Some are read only with the feature `pictures`; without it each such picture has an error.
const ENDINGS: [&str; 5] = ["png", "jpg", "jpeg", "webp", "exr"];

/// A picture that one folder or both have.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Pair {
    /// Its path within the folder.
    pub name: PathBuf,
    pub expected: Option<PathBuf>,
    pub actual: Option<PathBuf>,
}

/// All pictures of two folders and of those in them, by name.
///
/// # Errors
/// If a folder cannot be read.
pub fn pairs(expected: &Path, actual: &Path) -> io::Result<Vec<Pair>> {
    let [wanted, found] = [pictures(expected)?, pictures(actual)?];
    let pair = |name: &PathBuf| Pair {
        expected: wanted.contains(name).then(|| expected.join(name)),
        actual: found.contains(name).then(|| actual.join(name)),
        name: name.clone(),
    };
    Ok(wanted.union(&found).map(pair).collect())
}

/// The names of the pictures in a folder.
fn pictures(folder: &Path) -> io::Result<BTreeSet<PathBuf>> {
    let (mut found, mut left) = (BTreeSet::new(), vec![PathBuf::new()]);
    while let Some(below) = left.pop() {
        for entry in fs::read_dir(folder.join(&below))? {
            let entry = entry?;
            let name = below.join(entry.file_name());
            let ending = name.extension().and_then(|ending| ending.to_str()).unwrap_or("").to_lowercase();
            // A link to a folder may lead round in a circle.
            if entry.file_type()?.is_dir() {
                left.push(name);
            } else if ENDINGS.contains(&ending.as_str()) {
                found.insert(name);
            }
        }
    }
    Ok(found)
}
