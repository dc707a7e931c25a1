//! Wavefront OBJ.
//!
//! tobj is not used, because it renumbers the vertices of every group, drops vertices without a face, invents normals
//! for corners without any, and gives no line numbers in its errors. A test compares the geometry of both.
//!
//! A file is read in three passes. The first checks everything and keeps nothing, so that a rejected file takes no
//! memory beyond its own bytes. The second reads vertices, the third faces, which may refer to later vertices.

mod check;
mod line;

use std::collections::HashMap;
use std::path::Path;

use glam::Vec3;

use self::check::Check;
use self::line::{Line, corners, statements, vector};
use super::error::{Fault, quoted};
use super::mtl::Libraries;
use super::notes::Notes;
use super::polygon::Splitter;
use super::text::plain;
use crate::scene::{Material, Model};

/// Reads the text of an OBJ file and the MTL files that it names, which are searched in `folder`.
///
/// Vertices keep their order and number. A face is flat unless all its corners have normals.
pub(super) fn read(bytes: &[u8], folder: &Path) -> Result<Model, Fault> {
    let text = plain(bytes)?;
    let check = Check::over(text)?;
    let mut model = vertices(text, &check);
    let mut notes = Notes::default();
    check.note(&mut notes);

    let mut faces = Faces { smooth: check.smooth, ..Faces::default() };
    let (mut positions, mut normals) = (0, 0);
    for (number, line) in statements(text) {
        match Line::of(&line) {
            Line::Vertex(_) => positions += 1,
            Line::Normal(_) => normals += 1,
            Line::Face(words) => {
                faces.corners.clear();
                for corner in corners(words, positions, normals) {
                    faces.corners.push(corner.map_err(|problem| Fault::line(number, problem))?);
                }
                faces.add(&mut model);
            }
            Line::Material(name) => (faces.current, faces.material) = (Some(name), None),
            Line::Library(name) => faces.libraries.add(name),
            Line::Shape | Line::Skipped | Line::Empty | Line::Unknown(_) => {}
        }
    }
    faces.finish(&mut model, folder, &mut notes);
    model.notes = notes.into_vec();
    Ok(model)
}

/// A model with the vertices and normals of the file, and room for its triangles.
fn vertices(text: &[u8], check: &Check) -> Model {
    let mut model = Model::default();
    model.positions.reserve_exact(check.vertices);
    model.triangles.reserve_exact(check.triangles);
    if check.smooth {
        model.normals.reserve_exact(check.normals);
        model.normal_indices.reserve_exact(check.triangles);
    }
    for (_, line) in statements(text) {
        match Line::of(&line) {
            Line::Vertex(words) => model.positions.extend(vector(words)),
            Line::Normal(words) if check.smooth => model.normals.extend(vector(words)),
            _ => {}
        }
    }
    model
}

#[derive(Default)]
struct Faces {
    /// Whether any face has normals.
    smooth: bool,
    /// Material names in the order of their first use, and the same by name.
    used: Vec<String>,
    number_of: HashMap<String, u32>,
    /// The current material name, and its number once a face uses it.
    current: Option<String>,
    material: Option<u32>,
    libraries: Libraries,
    /// Corners of the face being read: vertex number and normal number or [`Model::FLAT`].
    corners: Vec<(u32, u32)>,
    points: Vec<Vec3>,
    splitter: Splitter,
}

impl Faces {
    fn add(&mut self, model: &mut Model) {
        if self.corners.len() < 3 {
            return;
        }
        let material = self.material();
        if material > 0 && model.material_of.is_empty() {
            model.material_of.resize(model.triangles.len(), 0);
        }
        self.points.clear();
        self.points.extend(self.corners.iter().map(|&(vertex, _)| model.positions[vertex as usize]));
        let smooth = self.corners.iter().all(|&(_, normal)| normal != Model::FLAT);
        for triangle in self.splitter.split(&self.points) {
            let triangle = triangle.map(|i| self.corners[i]);
            model.triangles.push(triangle.map(|(vertex, _)| vertex));
            if self.smooth {
                let normals = if smooth { triangle.map(|(_, normal)| normal) } else { [Model::FLAT; 3] };
                model.normal_indices.push(normals);
            }
            if self.used.len() > 1 {
                model.material_of.push(material);
            }
        }
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

    fn finish(self, model: &mut Model, folder: &Path, notes: &mut Notes) {
        self.splitter.note(notes);
        let mut known = self.libraries.read(&self.number_of, folder, notes);
        for name in self.used {
            let material = known.remove(&name).unwrap_or_else(|| {
                if name != "default" {
                    notes.add(format!("material {} is in no .mtl file: it is shaded light grey", quoted(&name)));
                }
                Material::named(name)
            });
            model.materials.push(material);
        }
    }
}
