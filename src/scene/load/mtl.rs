//! Wavefront MTL, the materials of OBJ files.

use std::collections::HashMap;
use std::path::{Path, PathBuf};

use glam::Vec3;

use super::error::quoted;
use super::read_file;
use crate::scene::Material;

/// Reads the files that the `mtllib` lines name. What cannot be read is a note and not an error, for the mesh is whole
/// without it. Of two materials with one name the later counts.
pub(super) fn read_all(libraries: &[String], folder: &Path, notes: &mut Vec<String>) -> HashMap<String, Material> {
    let mut known = HashMap::new();
    for library in libraries {
        for path in paths(library, folder) {
            match read_file(&path) {
                Ok(bytes) => read(&String::from_utf8_lossy(&bytes), &path, notes, &mut known),
                Err(cause) => notes.push(format!("the materials in {} cannot be read ({cause})", path.display())),
            }
        }
    }
    known
}

/// A line may name several files, or one with blanks in its name: the latter if there is one.
fn paths(library: &str, folder: &Path) -> Vec<PathBuf> {
    let path = |name: &str| folder.join(name.replace('\\', "/"));
    let whole = path(library);
    if whole.is_file() { vec![whole] } else { library.split_whitespace().map(path).collect() }
}

fn read(text: &str, path: &Path, notes: &mut Vec<String>, known: &mut HashMap<String, Material>) {
    // tobj panics on colours of fewer than three numbers, and one bad line costs it all materials of the file: it gets
    // to see only the lines that are used here, and whole.
    let mut clean = String::new();
    for (index, line) in text.lines().enumerate() {
        match usable(line) {
            Ok(None) => {}
            Ok(Some(line)) => clean = clean + &line + "\n",
            Err(()) => notes.push(format!("{}, line {}: {} is ignored", path.display(), index + 1, quoted(line))),
        }
    }
    match tobj::load_mtl_buf(&mut clean.as_bytes()) {
        Ok((materials, _)) => known.extend(materials.into_iter().map(|m| (m.name.clone(), material(m)))),
        Err(cause) => notes.push(format!("the materials in {} cannot be read ({cause})", path.display())),
    }
}

/// The line as tobj can read it, nothing when it says nothing of interest, an error when its numbers are wrong.
fn usable(line: &str) -> Result<Option<String>, ()> {
    let mut words = line.split_whitespace();
    let Some(keyword) = words.next() else { return Ok(None) };
    let count = match keyword {
        "newmtl" => return words.next().map(|_| Some(line.trim().to_owned())).ok_or(()),
        "Ka" | "Kd" | "Ks" => 3,
        "Ns" => 1,
        _ => return Ok(None),
    };
    let parse = |word: &str| word.parse::<f32>().ok().filter(|number| number.is_finite()).ok_or(());
    let numbers: Vec<f32> = words.take(count).map(parse).collect::<Result<_, ()>>()?;
    match (numbers[..].iter().as_slice(), count) {
        // A colour of one number is grey.
        ([grey], 3) => Ok(Some(format!("{keyword} {grey} {grey} {grey}"))),
        ([r, g, b], 3) => Ok(Some(format!("{keyword} {r} {g} {b}"))),
        ([number], 1) => Ok(Some(format!("{keyword} {number}"))),
        _ => Err(()),
    }
}

fn material(read: tobj::Material) -> Material {
    let plain = Material::named(read.name);
    let colour = |read: Option<[f32; 3]>, plain| read.map_or(plain, |c| Vec3::from(c).clamp(Vec3::ZERO, Vec3::ONE));
    Material {
        ambient: colour(read.ambient, plain.ambient),
        diffuse: colour(read.diffuse, plain.diffuse),
        specular: colour(read.specular, plain.specular),
        shininess: read.shininess.map_or(plain.shininess, |n| n.max(0.0)),
        ..plain
    }
}
