//! Wavefront MTL, the materials of OBJ files, by tobj.

use std::collections::HashSet;
use std::path::{Path, PathBuf};

use glam::Vec3;
use indexmap::{IndexMap, IndexSet};

use super::error::quoted;
use super::files::{named_below, read_start};
use super::notes::Notes;
use super::text::{lines, name, plain, words};
use crate::escaped::Escaped as _;
use crate::scene::Material;

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
    let mut materials: Materials = names.into_iter().map(|name| (name, None)).collect();
    let mut files: HashSet<PathBuf> = HashSet::new();
    for path in libraries.iter().flat_map(|names| paths(names, folder)) {
        match path {
            Ok(path) if !files.insert(path.clone()) => {}
            Ok(path) => read_library(&path, &mut materials, notes).unwrap_or_else(|problem| notes.add(problem)),
            Err(problem) => notes.add(problem),
        }
    }
    let textured = materials.values().flatten().filter(|(_, has_texture)| *has_texture).count();
    notes.count(textured, "material", "with a texture, which is ignored: Kd is used");

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
        // tobj refuses the empty name, to which `usemtl` alone refers, and keeps a comment after a name.
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
        Some(b"Ka" | b"Kd" | b"Ks" | b"Ns") => {
            let values = values(line)?;
            for (own, colour) in [
                (&mut material.ambient, values.ambient),
                (&mut material.diffuse, values.diffuse),
                (&mut material.specular, values.specular),
            ] {
                *own = colour.map_or(*own, |colour| Vec3::from(colour).clamp(Vec3::ZERO, Vec3::ONE));
            }
            material.shininess = values.shininess.map_or(material.shininess, |shininess| shininess.max(0.0));
        }
        Some(b"bump" | b"norm" | b"disp" | b"decal") => *has_texture |= words.next().is_some(),
        Some(keyword) if keyword.starts_with(b"map_") => *has_texture |= words.next().is_some(),
        _ => {}
    }
    Some(())
}

/// The values of a statement; empty if it is wrong. tobj gets each separately, because a value that it rejects voids
/// the whole library; it panics on a colour of fewer than three numbers (a single one is a grey), and accepts nan and
/// inf.
fn values(line: &[u8]) -> Option<tobj::Material> {
    let line = str::from_utf8(line).ok()?;
    let words: Vec<&str> = line.split_whitespace().take_while(|word| !word.starts_with('#')).collect();
    let statement = match words[..] {
        [colour, grey] if colour != "Ns" => [colour, grey, grey, grey].join(" "),
        ["Ns", ..] | [_, _, _, _, ..] => words.join(" "),
        _ => return None,
    };
    let (materials, _) = tobj::load_mtl_buf(&mut format!("newmtl a\n{statement}").as_bytes()).ok()?;
    let values = materials.into_iter().next()?;
    let colours = [values.ambient, values.diffuse, values.specular];
    let mut numbers = colours.iter().flatten().flatten().chain(&values.shininess);
    numbers.all(|number| number.is_finite()).then_some(values)
}
