//! PLY, the Stanford polygon format (Turk 1994), ASCII and binary.

mod element;
mod number;

use glam::Vec3;

use self::element::{Element, Header, STRIPS, VERTEX_PROPERTIES};
use super::error::Fault;
use super::notes::{Notes, SMALL};
use crate::scene::polygon::Splitter;
use crate::scene::{Material, Model};

/// Faces are read twice. The first pass stores no faces, because a rejected file must take little memory.
pub(super) fn read(bytes: &[u8]) -> Result<Model, Fault> {
    let (elements, mut rows) = Header::read(bytes)?;
    let vertex = elements.iter().find(|element| element.name == "vertex");
    let vertex = vertex.ok_or_else(|| Fault::file("the PLY header declares no element `vertex`: there is no mesh"))?;
    let mut model = Model { materials: vec![Material::named("default")], ..Model::default() };
    let (mut surfaces, mut triangles, mut small) = (vec![], 0, 0);
    for element in &elements {
        match element.name.as_str() {
            "vertex" => vertices(element, &mut rows, &mut model)?,
            "face" | STRIPS => {
                surfaces.push((element, rows));
                polygons(element, &mut rows, vertex.count, |corners| {
                    triangles += corners.len().saturating_sub(2);
                    small += usize::from(corners.len() < 3);
                })?;
            }
            _ => element.read(&mut rows, |_| Ok(()))?,
        }
    }
    rows = rows.trim_ascii_start();
    if !rows.iter().all(|byte| byte.is_ascii_whitespace() || *byte == 0) {
        let problem = format!("{} bytes follow the last row: the counts in the header are too small", rows.len());
        return Err(Fault::file(problem));
    }
    if triangles == 0 {
        let problem = "no element `face` or `tristrips` has a row with three corners: point clouds are not meshes";
        return Err(Fault::file(format!("it has no triangles: {} vertices, but {problem}", vertex.count)));
    }

    model.triangles.reserve_exact(triangles);
    let (mut splitter, mut points) = (Splitter::default(), vec![]);
    for (element, mut rows) in surfaces {
        polygons(element, &mut rows, vertex.count, |corners| {
            if let &[a, b, c] = corners {
                return model.triangles.push([a, b, c]);
            }
            points.clear();
            points.extend(corners.iter().map(|&corner| model.positions[corner as usize]));
            let triangles = splitter.split(&points).iter();
            model.triangles.extend(triangles.map(|triangle| triangle.map(|i| corners[i])));
        })?;
    }
    if !model.normals.is_empty() {
        model.normal_indices = model.triangles.clone();
    }
    let mut notes = Notes::default();
    notes.count(small, "face", SMALL);
    splitter.defects().into_iter().for_each(|(count, defect)| notes.count(count, "polygon", defect));
    model.notes = notes.into_vec();
    Ok(model)
}

fn vertices(element: &Element, rows: &mut &[u8], model: &mut Model) -> Result<(), Fault> {
    let has = |column: &usize| element.properties.iter().any(|property| property.column == Some(*column));
    if let Some(axis) = (0..3).find(|axis| !has(axis)) {
        return Err(Fault::part("element vertex", format!("the property `{}` is missing", VERTEX_PROPERTIES[axis])));
    }
    let smooth = (3..VERTEX_PROPERTIES.len()).all(|column| has(&column));
    // A vertex takes at least three bytes.
    model.positions.reserve_exact(element.count.min(rows.len() / 3));
    model.normals.reserve_exact(if smooth { model.positions.capacity() } else { 0 });
    let mut vectors = [0.0; VERTEX_PROPERTIES.len()];
    element.read(rows, |number| {
        if let Some((column, number)) = number {
            vectors[column] = number as f32;
            return Ok(());
        }
        let [x, y, z, normal @ ..] = vectors;
        if ![x, y, z].into_iter().all(f32::is_finite) {
            return Err(format!("its coordinates ({x:?}, {y:?}, {z:?}) are not finite numbers"));
        }
        model.positions.push(Vec3::new(x, y, z));
        model.normals.extend(smooth.then_some(Vec3::from_array(normal)));
        Ok(())
    })
}

/// `take` receives the corners of each face, or the corners of each triangle of a strip.
fn polygons(element: &Element, rows: &mut &[u8], vertices: usize, mut take: impl FnMut(&[u32])) -> Result<(), Fault> {
    if element.properties.iter().filter(|property| property.column.is_some()).count() != 1 {
        let problem = "it must have one list of corners, with the name `vertex_indices`";
        return Err(Fault::part(format!("element {}", element.name), problem));
    }
    let is_strip = element.name == STRIPS;
    let (mut corners, mut triangles) = (vec![], 0);
    element.read(rows, |number| {
        match number {
            Some((_, corner)) if corner >= 0.0 && corner < vertices as f64 => {
                corners.push(corner as u32);
                if is_strip && corners.len() == 3 {
                    take(&corners);
                    // The next triangle shares an edge with this triangle, in the opposite direction.
                    corners.swap_remove(triangles % 2);
                    triangles += 1;
                }
            }
            Some((_, corner)) if !is_strip || corner != -1.0 => {
                return Err(format!("its corner {corner} is not one of the {vertices} vertices"));
            }
            // The end of a row, or -1 for the end of a strip.
            _ => {
                if !is_strip || triangles == 0 && !corners.is_empty() {
                    take(&corners);
                }
                corners.clear();
                triangles = 0;
            }
        }
        Ok(())
    })
}
