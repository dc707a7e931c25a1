//! Wavefront OBJ.
//!
//! The geometry is read here and not by tobj, which renumbers the vertices of every group, drops those without a face,
//! makes up normals for corners that have none and names no line in its errors. A test compares the two.

use std::collections::HashMap;
use std::path::Path;
use std::str::SplitWhitespace;

use glam::Vec3;

use super::error::{Fault, quoted};
use super::mtl;
use crate::scene::{Material, Model};

/// Reads the text of an OBJ file and the MTL files that it names, which are searched in `folder`.
///
/// Vertices keep their order and number. A face is flat unless all its corners have normals.
pub(super) fn read(bytes: &[u8], folder: &Path) -> Result<Model, Fault> {
    // Names may be in any encoding; a stray byte in a number is found where the number is read.
    let text = String::from_utf8_lossy(bytes);
    let mut reader = Reader::default();
    let mut continued = String::new();
    let mut last = 0;
    for (index, line) in text.lines().enumerate() {
        last = index + 1;
        if let Some(head) = line.strip_suffix('\\') {
            continued.push_str(head);
            continued.push(' ');
        } else if continued.is_empty() {
            reader.line(last, line)?;
        } else {
            continued.push_str(line);
            reader.line(last, &continued)?;
            continued.clear();
        }
    }
    reader.line(last, &continued)?;
    reader.finish(folder)
}

#[derive(Default)]
struct Reader {
    model: Model,
    /// Material names in the order of their first use, and the same by name.
    used: Vec<String>,
    number_of: HashMap<String, u32>,
    /// The name of the material of the faces to come, and its number once a face has it.
    current: Option<String>,
    material: Option<u32>,
    libraries: Vec<String>,
    vertices: Highest,
    normals: Highest,
    /// Corners of the face being read: vertex number and normal number or [`Model::FLAT`].
    corners: Vec<(u32, u32)>,
    thin_faces: usize,
}

/// The highest index that a face uses and its line. Indices may point forward, so the end of the file judges it.
#[derive(Default)]
struct Highest {
    index: u32,
    line: usize,
}

impl Reader {
    fn line(&mut self, number: usize, line: &str) -> Result<(), Fault> {
        let mut words = line.split_whitespace();
        let Some(keyword) = words.next() else { return Ok(()) };
        let rest = || line.trim_start()[keyword.len()..].trim();
        let result = match keyword {
            "v" => vector(words).and_then(|v| {
                let finite = v.is_finite();
                self.model.positions.push(v);
                finite
                    .then_some(())
                    .ok_or_else(|| format!("vertex {} is not finite: {}", self.model.positions.len(), quoted(line)))
            }),
            "vn" => vector(words).map(|n| self.model.normals.push(n)),
            "f" => self.face(number, words),
            "usemtl" => {
                (self.current, self.material) = (Some(rest().to_owned()), None);
                Ok(())
            }
            "mtllib" => {
                self.libraries.push(rest().to_owned());
                Ok(())
            }
            // Groups, texture coordinates, points, lines and curves.
            _ => Ok(()),
        };
        result.map_err(|problem| Fault::line(number, problem))
    }

    fn material(&mut self) -> u32 {
        if let Some(number) = self.material {
            return number;
        }
        let name = self.current.as_deref().unwrap_or("default");
        let number = *self.number_of.entry(name.to_owned()).or_insert_with(|| {
            self.used.push(name.to_owned());
            self.used.len() as u32 - 1
        });
        self.material = Some(number);
        number
    }

    fn face(&mut self, line: usize, words: SplitWhitespace) -> Result<(), String> {
        self.corners.clear();
        for word in words.take_while(|word| !word.starts_with('#')) {
            let mut parts = word.split('/');
            let vertex = parts.next().unwrap_or_default();
            let vertex = resolve(vertex, "vertex", self.model.positions.len(), &mut self.vertices, line)?;
            let normal = match parts.nth(1) {
                None | Some("") => Model::FLAT,
                Some(normal) => resolve(normal, "normal", self.model.normals.len(), &mut self.normals, line)?,
            };
            if parts.next().is_some() {
                return Err(format!("the corner {} has more than three indices", quoted(word)));
            }
            self.corners.push((vertex, normal));
        }
        if self.corners.len() < 3 {
            self.thin_faces += 1;
            return Ok(());
        }

        let material = self.material();
        let smooth = self.corners.iter().all(|&(_, normal)| normal != Model::FLAT);
        let first = self.corners[0];
        for pair in self.corners[1..].windows(2) {
            let fan = [first, pair[0], pair[1]];
            self.model.triangles.push(fan.map(|(vertex, _)| vertex));
            self.model.normal_indices.push(if smooth { fan.map(|(_, normal)| normal) } else { [Model::FLAT; 3] });
            self.model.material_of.push(material);
        }
        Ok(())
    }

    fn finish(self, folder: &Path) -> Result<Model, Fault> {
        let mut model = self.model;
        for (highest, count, what) in
            [(&self.vertices, model.positions.len(), "vertex"), (&self.normals, model.normals.len(), "normal")]
        {
            if highest.index as usize > count {
                let problem = format!(
                    "a face names {what} {}, but the file has only {count}: it is truncated or wrongly numbered",
                    highest.index
                );
                return Err(Fault::line(highest.line, problem));
            }
        }

        // Drop what says nothing.
        if model.normal_indices.iter().all(|n| *n == [Model::FLAT; 3]) {
            model.normals = Vec::new();
            model.normal_indices = Vec::new();
        }
        if self.used.len() < 2 {
            model.material_of = Vec::new();
        }
        if self.thin_faces > 0 {
            model.notes.push(format!("{} faces with fewer than three corners are left out", self.thin_faces));
        }

        let known = mtl::read_all(&self.libraries, folder, &mut model.notes);
        for name in self.used {
            let material = known.get(&name).cloned().unwrap_or_else(|| {
                if name != "default" {
                    model.notes.push(format!("material {} is in no .mtl file: it is shaded light grey", quoted(&name)));
                }
                Material::named(name)
            });
            model.materials.push(material);
        }
        if model.materials.is_empty() {
            model.materials.push(Material::named("default"));
        }
        Ok(model)
    }
}

/// The first three numbers of a line; a fourth coordinate and colours are ignored.
fn vector(mut words: SplitWhitespace) -> Result<Vec3, String> {
    let mut next = || match words.next() {
        None => Err("three numbers are needed: the file may be truncated".to_owned()),
        Some(word) => word.parse::<f32>().map_err(|_| format!("{} is not a number", quoted(word))),
    };
    Ok(Vec3::new(next()?, next()?, next()?))
}

/// Turns an index that counts from 1, or backwards from -1, into one that counts from 0.
fn resolve(word: &str, what: &str, count: usize, highest: &mut Highest, line: usize) -> Result<u32, String> {
    let index: i64 = word.parse().map_err(|_| format!("{} is not a {what} index", quoted(word)))?;
    match index {
        0 => Err(format!("{what} index 0: indices count from 1, or backwards from -1")),
        1.. => {
            let index = u32::try_from(index).map_err(|_| format!("{what} {index} is more than a mesh can hold"))?;
            if index > highest.index {
                *highest = Highest { index, line };
            }
            Ok(index - 1)
        }
        _ => match usize::try_from(count as i64 + index) {
            Ok(index) => Ok(index as u32),
            Err(_) => Err(format!("{what} index {index} reaches before the first of the {count} so far")),
        },
    }
}
