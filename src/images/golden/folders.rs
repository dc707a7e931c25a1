//! Pairs the pictures of two folders by name.

use std::collections::BTreeSet;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

const ENDINGS: [&str; 5] = ["png", "jpg", "jpeg", "webp", "exr"];

#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Pair {
    /// The path relative to each of the two folders.
    pub name: PathBuf,
    pub expected: Option<PathBuf>,
    pub actual: Option<PathBuf>,
}

/// All pictures of two folders and their subfolders, sorted by name.
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

fn pictures(folder: &Path) -> io::Result<BTreeSet<PathBuf>> {
    let (mut found, mut left) = (BTreeSet::new(), vec![PathBuf::new()]);
    while let Some(below) = left.pop() {
        for entry in fs::read_dir(folder.join(&below))? {
            let entry = entry?;
            let name = below.join(entry.file_name());
            let ending = name.extension().and_then(|ending| ending.to_str()).unwrap_or("").to_lowercase();
            // Symbolic links to folders are not followed, because links may form a cycle.
            if entry.file_type()?.is_dir() {
                left.push(name);
            } else if ENDINGS.contains(&ending.as_str()) {
                found.insert(name);
            }
        }
    }
    Ok(found)
}
