//! Pictures of two folders, by their names.

use std::collections::BTreeMap;
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
    let [wanted, mut found] = [pictures(expected)?, pictures(actual)?];
    let mut pairs: Vec<Pair> = vec![];
    for (name, expected) in wanted {
        let actual = found.remove(&name);
        pairs.push(Pair { name, expected: Some(expected), actual });
    }
    pairs.extend(found.into_iter().map(|(name, actual)| Pair { name, expected: None, actual: Some(actual) }));
    pairs.sort_by(|one, other| one.name.cmp(&other.name));
    Ok(pairs)
}

fn pictures(folder: &Path) -> io::Result<BTreeMap<PathBuf, PathBuf>> {
    let (mut found, mut left) = (BTreeMap::new(), vec![PathBuf::new()]);
    while let Some(below) = left.pop() {
        for entry in fs::read_dir(folder.join(&below))? {
            let entry = entry?;
            let name = below.join(entry.file_name());
            let ending = name.extension().and_then(|ending| ending.to_str()).unwrap_or("").to_lowercase();
            // A link to a folder may lead round in a circle.
            if entry.file_type()?.is_dir() {
                left.push(name);
            } else if ENDINGS.contains(&ending.as_str()) {
                found.insert(name, entry.path());
            }
        }
    }
    Ok(found)
}
