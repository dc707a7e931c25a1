//! Wavefront MTL, the materials of OBJ files, by tobj.

use std::collections::HashMap;
use std::path::{Path, PathBuf};

use glam::Vec3;

use super::error::quoted;
use super::files::{canonical, named_below, read_start};
use super::notes::Notes;
use super::text::{lines, name, plain, words};
use crate::escaped::Escaped as _;
use crate::scene::Material;

/// The most libraries that are read, more than any exporter writes.
pub(super) const MOST_LIBRARIES: usize = 64;

/// A material, and whether it has a texture.
type Known = HashMap<Vec<u8>, (Material, bool)>;

/// Reads the materials whose names are keys of `used`, each library once. A library that cannot be read gives a note and
/// not an error, because the mesh is complete without it. Of two materials with one name the later counts.
pub(super) fn read(
    libraries: &[Vec<u8>],
    used: &HashMap<Vec<u8>, u32>,
    folder: &Path,
    notes: &mut Notes,
) -> HashMap<Vec<u8>, Material> {
    let paths = libraries.iter().flat_map(|names| paths(names, folder));
    let mut paths: Vec<_> = paths.take(MOST_LIBRARIES + 1).collect();
    if paths.len() > MOST_LIBRARIES {
        paths.pop();
        notes.add(format!("of the material files, only the first {MOST_LIBRARIES} are read"));
    }
    let mut known = Known::new();
    let mut files: Vec<PathBuf> = vec![];
    for path in paths {
        let path = match path {
            Ok(path) => path,
            Err(problem) => {
                notes.add(problem);
                continue;
            }
        };
        let file = canonical(path.clone());
        if files.contains(&file) {
            continue;
        }
        files.push(file);
        match read_start(&path, u64::MAX) {
            Ok(bytes) => read_library(&bytes, &path, used, &mut known, notes),
            Err(cause) => notes.add(format!("the materials in {} cannot be read ({cause})", path.escaped())),
        }
    }
    let textured = [
        "material has a texture, which is left out: it shows Kd as it is",
        "materials have textures, which are left out: they show Kd as it is",
    ];
    notes.count(known.values().filter(|(_, has_texture)| *has_texture).count(), textured);
    known.into_iter().map(|(name, (material, _))| (name, material)).collect()
}

/// The files that a line names: one file whose name contains spaces, if it exists, otherwise several.
fn paths<'a>(names: &'a [u8], folder: &'a Path) -> Box<dyn Iterator<Item = Result<PathBuf, String>> + 'a> {
    let path = move |name: &[u8]| {
        let slashes: Vec<u8> = name.iter().map(|&byte| if byte == b'\\' { b'/' } else { byte }).collect();
        named_below(folder, &slashes).ok_or_else(|| {
            format!("the material file {} is not below the folder of this file: it is not read", quoted(name))
        })
    };
    match path(names) {
        Ok(whole) if whole.is_file() => Box::new(std::iter::once(Ok(whole))),
        _ => Box::new(words(names).map(path)),
    }
}

fn read_library(bytes: &[u8], path: &Path, used: &HashMap<Vec<u8>, u32>, known: &mut Known, notes: &mut Notes) {
    let text = match plain(bytes) {
        Ok(text) => text,
        Err(fault) => return notes.add(format!("{}: {}", path.escaped(), fault.problem)),
    };
    // The current material; none if no face uses it.
    let mut current = None;
    for (number, line) in lines(text) {
        // tobj refuses the empty name, to which `usemtl` alone refers, and keeps a comment after a name.
        if words(line).next() == Some(b"newmtl") {
            let name = name(line);
            let new = (Material::named(String::from_utf8_lossy(name)), false);
            current = used.contains_key(name).then(|| known.entry(name.to_vec()).insert_entry(new).into_mut());
        } else if let Some(material) = &mut current
            && read_value(line, material).is_none()
        {
            notes.add(format!("{}, line {number}: {} is ignored", path.escaped(), quoted(line)));
        }
    }
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
        Some(keyword) if is_texture(keyword) => *has_texture |= words.next().is_some(),
        _ => {}
    }
    Some(())
}

fn is_texture(keyword: &[u8]) -> bool {
    keyword.starts_with(b"map_") || [&b"bump"[..], b"norm", b"disp", b"decal"].contains(&keyword)
}

/// The values of a statement, none if it is wrong. tobj gets each by itself, because one that it refuses voids the whole
/// library; it panics on a colour of fewer than three numbers, of which one is a grey, and takes nan and inf.
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
