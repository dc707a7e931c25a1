//! Wavefront MTL, the materials of OBJ files.
//!
//! tobj is not used: it panics on a grey, and one line that it refuses voids the whole library.

use std::collections::HashSet;
use std::path::{Path, PathBuf};

use glam::Vec3;
use indexmap::{IndexMap, IndexSet};

use super::error::quoted;
use super::files::{named_below, read_start};
use super::notes::Notes;
use super::text::{lines, name, number, plain, words};
use crate::escaped::Escaped as _;
use crate::scene::Material;

/// The most libraries that are read, more than any exporter writes.
const MOST_LIBRARIES: usize = 64;

/// By their names, the materials that a library defines, and whether they have a texture.
type Materials = IndexMap<Vec<u8>, Option<(Material, bool)>>;

/// Reads the materials with these names, each library once. A library that cannot be read gives a note and not an error,
/// because the mesh is complete without it. Of two materials with one name the later counts.
pub(super) fn read(
    libraries: IndexSet<Vec<u8>>,
    names: IndexSet<Vec<u8>>,
    folder: &Path,
    notes: &mut Notes,
) -> Vec<Material> {
    let paths = libraries.iter().flat_map(|names| paths(names, folder));
    let mut paths: Vec<_> = paths.take(MOST_LIBRARIES + 1).collect();
    if paths.len() > MOST_LIBRARIES {
        paths.pop();
        notes.add(format!("only the first {MOST_LIBRARIES} material files are read"));
    }
    let mut materials: Materials = names.into_iter().map(|name| (name, None)).collect();
    let mut files: HashSet<PathBuf> = HashSet::new();
    for path in paths {
        match path {
            Ok(path) if !files.insert(path.clone()) => {}
            Ok(path) => read_library(&path, &mut materials, notes).unwrap_or_else(|problem| notes.add(problem)),
            Err(problem) => notes.add(problem),
        }
    }
    let textured = ["material has a texture: ignored, Kd is used", "materials have textures: ignored, Kd is used"];
    notes.count(materials.values().flatten().filter(|(_, has_texture)| *has_texture).count(), textured);

    let all = materials.into_iter().map(|(name, defined)| {
        if defined.is_none() && name != b"default" {
            notes.add(format!("material {} is in no .mtl file: shaded light grey", quoted(&name)));
        }
        defined.map_or_else(|| Material::named(String::from_utf8_lossy(&name)), |(material, _)| material)
    });
    all.collect()
}

/// The files that a line names: one file whose name contains spaces, if it exists, otherwise several.
fn paths<'a>(names: &'a [u8], folder: &'a Path) -> Box<dyn Iterator<Item = Result<PathBuf, String>> + 'a> {
    let path = move |name: &[u8]| {
        let slashes: Vec<u8> = name.iter().map(|&byte| if byte == b'\\' { b'/' } else { byte }).collect();
        named_below(folder, &slashes)
            .ok_or_else(|| format!("the material file {} is outside the folder of this file: not read", quoted(name)))
    };
    match path(names) {
        Ok(whole) if whole.is_file() => Box::new(std::iter::once(Ok(whole))),
        _ => Box::new(words(names).map(path)),
    }
}

fn read_library(path: &Path, materials: &mut Materials, notes: &mut Notes) -> Result<(), String> {
    let shown = path.escaped();
    let unread = |cause| format!("cannot read the materials in {shown} ({cause})");
    let bytes = read_start(path, u64::MAX).map_err(unread)?;
    let text = plain(&bytes).map_err(|fault| format!("{shown}: {}", fault.problem))?;
    // The current material; none if no face uses it.
    let mut current = None;
    for (number, line) in lines(text) {
        if words(line).next() == Some(b"newmtl") {
            let name = name(line);
            let defined = materials.get_mut(name);
            current = defined.map(|defined| defined.insert((Material::named(String::from_utf8_lossy(name)), false)));
        } else if let Some(material) = &mut current
            && read_value(line, material).is_none()
        {
            notes.add(format!("{shown}, line {number}: {} is ignored", quoted(line)));
        }
    }
    Ok(())
}

/// Reads a line about a material; none if its numbers are wrong.
fn read_value(line: &[u8], (material, has_texture): &mut (Material, bool)) -> Option<()> {
    let mut words = words(line);
    match words.next() {
        Some(b"Ka") => material.ambient = colour(words)?,
        Some(b"Kd") => material.diffuse = colour(words)?,
        Some(b"Ks") => material.specular = colour(words)?,
        Some(b"Ns") => material.shininess = finite(words.next()?)?.max(0.0),
        Some(keyword) if is_texture(keyword) => *has_texture |= words.next().is_some(),
        _ => {}
    }
    Some(())
}

/// A colour of three numbers, or a grey of one.
fn colour<'w>(words: impl Iterator<Item = &'w [u8]>) -> Option<Vec3> {
    let numbers: Option<Vec<f32>> = words.take(3).map(finite).collect();
    let colour = match numbers?[..] {
        [grey] => Vec3::splat(grey),
        [red, green, blue] => Vec3::new(red, green, blue),
        _ => return None,
    };
    Some(colour.clamp(Vec3::ZERO, Vec3::ONE))
}

fn finite(word: &[u8]) -> Option<f32> {
    number(word).filter(|number: &f32| number.is_finite())
}

fn is_texture(keyword: &[u8]) -> bool {
    keyword.starts_with(b"map_") || [&b"bump"[..], b"norm", b"disp", b"decal"].contains(&keyword)
}
