//! Wavefront MTL: the materials of OBJ files, read with the crate `tobj`.

use std::collections::HashSet;
use std::path::{Path, PathBuf};

use glam::Vec3;
use indexmap::{IndexMap, IndexSet};

use super::error::quoted;
use super::files::{named_below, read_start};
use super::notes::Notes;
use super::text::{lines, name, without_byte_order_mark, words};
use crate::escaped::Escaped as _;
use crate::scene::Material;

/// A material is `None` until a library defines the material. The flag is true if the material has a texture.
type Materials = IndexMap<Vec<u8>, Option<(Material, bool)>>;

/// An unreadable library causes a note instead of an error, because the mesh is complete without materials. A later
/// material replaces an earlier material with the same name.
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

/// `names` is one file name with spaces, or a list of file names.
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
    let text = without_byte_order_mark(&bytes).map_err(|fault| format!("{shown}: {}", fault.problem))?;
    // `None` for a material that no face uses.
    let mut current = None;
    for (number, line) in lines(text) {
        // tobj does not receive the name, because tobj rejects an empty name.
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

/// tobj receives each statement separately, because tobj rejects a library for a single invalid value. tobj panics on a
/// colour with fewer than three numbers. tobj accepts nan and inf. A colour with a single number is a grey.
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
