//! Wavefront MTL, the materials of OBJ files.

use std::collections::{HashMap, HashSet};
use std::fs;
use std::path::{Path, PathBuf};

use glam::Vec3;

use super::error::quoted;
use super::notes::Notes;
use super::text::{after_keyword, lines, number, plain, words};
use super::{below, read_file};
use crate::escaped::Escaped as _;
use crate::scene::Material;

/// The most libraries that are read, more than any exporter writes.
const MOST_LIBRARIES: usize = 64;

#[derive(Default)]
pub(super) struct Libraries {
    named: Vec<String>,
    more: usize,
}

impl Libraries {
    pub fn add(&mut self, line: String) {
        match self.named.contains(&line) {
            true => {}
            false if self.named.len() < MOST_LIBRARIES => self.named.push(line),
            false => self.more += 1,
        }
    }

    /// Reads the materials that are keys of `used`, each library once. A library that cannot be read gives a note and
    /// not an error, because the mesh is complete without it. Of two materials with one name the later counts.
    pub fn read(&self, used: &HashMap<String, u32>, folder: &Path, notes: &mut Notes) -> HashMap<String, Material> {
        let mut reader = Reader { known: HashMap::new(), used, textured: HashSet::new() };
        let mut files: Vec<PathBuf> = Vec::new();
        for path in self.named.iter().flat_map(|line| paths(line, folder)) {
            let path = match path {
                Ok(path) => path,
                Err(problem) => {
                    notes.add(problem);
                    continue;
                }
            };
            // The same file may have several names.
            let file = fs::canonicalize(&path).unwrap_or_else(|_| path.clone());
            if files.contains(&file) {
                continue;
            }
            if files.len() == MOST_LIBRARIES {
                notes.add(format!("of the material files, only the first {MOST_LIBRARIES} are read"));
                break;
            }
            files.push(file);
            match read_file(&path) {
                Ok(bytes) => reader.read(&bytes, &path, notes),
                Err(cause) => notes.add(format!("the materials in {} cannot be read ({cause})", path.escaped())),
            }
        }
        let [one, many] = [("line", "is"), ("lines", "are")]
            .map(|(lines, are)| format!("mtllib {lines} after the first {MOST_LIBRARIES} {are} not followed"));
        notes.count(self.more, [&one, &many]);
        let textured = [
            "material has a texture, which is left out: it shows Kd as it is",
            "materials have textures, which are left out: they show Kd as it is",
        ];
        notes.count(reader.textured.len(), textured);
        reader.known
    }
}

/// The files that a line names: one file whose name contains spaces, if it exists, otherwise several.
fn paths(line: &str, folder: &Path) -> Vec<Result<PathBuf, String>> {
    let path = |name: &str| {
        let outside =
            || format!("the material file {} is not below the folder of this file: it is not read", quoted(name));
        below(folder, &name.replace('\\', "/")).ok_or_else(outside)
    };
    match path(line) {
        Ok(whole) if whole.is_file() => vec![Ok(whole)],
        _ => line.split_whitespace().map(path).collect(),
    }
}

struct Reader<'a> {
    known: HashMap<String, Material>,
    used: &'a HashMap<String, u32>,
    /// Names of used materials with a texture.
    textured: HashSet<String>,
}

impl Reader<'_> {
    fn read(&mut self, bytes: &[u8], path: &Path, notes: &mut Notes) {
        let text = match plain(bytes) {
            Ok(text) => text,
            Err(fault) => return notes.add(format!("{}: {}", path.escaped(), fault.problem)),
        };
        // The current material; none if no face uses it.
        let mut current: Option<String> = None;
        for (number, line) in lines(text) {
            if self.line(line, &mut current).is_err() {
                notes.add(format!("{}, line {number}: {} is ignored", path.escaped(), quoted(line)));
            }
        }
    }

    /// Reads a line. Unused statements are skipped; wrong numbers are an error.
    fn line(&mut self, line: &[u8], current: &mut Option<String>) -> Result<(), ()> {
        let mut words = words(line);
        let Some(keyword) = words.next() else { return Ok(()) };
        if keyword == b"newmtl" {
            // The empty name is valid: `usemtl` alone refers to it.
            let name = after_keyword(line);
            *current = self.used.contains_key(&name).then_some(name);
            if let Some(name) = current {
                self.known.insert(name.clone(), Material::named(name.clone()));
                self.textured.remove(name);
            }
            return Ok(());
        }
        let Some(material) = current.as_ref().and_then(|name| self.known.get_mut(name)) else { return Ok(()) };
        match keyword {
            b"Ka" => material.ambient = colour(words)?,
            b"Kd" => material.diffuse = colour(words)?,
            b"Ks" => material.specular = colour(words)?,
            b"Ns" => material.shininess = finite(words.next().ok_or(())?)?.max(0.0),
            _ if is_texture(keyword) && words.next().is_some() => {
                self.textured.insert(material.name.clone());
            }
            _ => {}
        }
        Ok(())
    }
}

fn is_texture(keyword: &[u8]) -> bool {
    keyword.starts_with(b"map_") || [&b"bump"[..], b"norm", b"disp", b"decal"].contains(&keyword)
}

/// Three numbers, or one for a grey, from 0 to 1.
fn colour<'a>(words: impl Iterator<Item = &'a [u8]>) -> Result<Vec3, ()> {
    let numbers: Vec<f32> = words.take(3).map(finite).collect::<Result<_, ()>>()?;
    match numbers[..] {
        [grey] => Ok(Vec3::splat(grey)),
        [r, g, b] => Ok(Vec3::new(r, g, b)),
        _ => Err(()),
    }
    .map(|colour| colour.clamp(Vec3::ZERO, Vec3::ONE))
}

fn finite(word: &[u8]) -> Result<f32, ()> {
    number::<f32>(word).filter(|number| number.is_finite()).ok_or(())
}
