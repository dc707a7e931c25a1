//! PLY, the Stanford polygon format (Turk 1994), ASCII and binary.

mod body;
mod header;
mod value;

use glam::Vec3;

use self::body::Body;
use self::header::{CORNERS, Header};
use super::error::Fault;
use super::notes::{Notes, SMALL_FACES};
use super::polygon::Splitter;
use crate::scene::{Material, Model};

/// The properties of a vertex that are read.
const VECTORS: [&str; 6] = ["x", "y", "z", "nx", "ny", "nz"];

/// Reads a PLY file: the positions and, if there are any, normals of its vertices, and the triangles of its faces.
///
/// All rows are read twice: the first pass checks everything and keeps nothing, so that a rejected file takes no memory
/// beyond its own bytes.
pub(super) fn read(bytes: &[u8]) -> Result<Model, Fault> {
    let (header, rest) = Header::read(bytes)?;
    let Some((vertex, face)) = header.element("vertex").zip(header.element("face")) else {
        return Err(Fault::file("the PLY header declares no mesh"));
    };
    let checked = check(&header, vertex.count, Body::new(&header, rest))?;

    let smooth = VECTORS.iter().all(|name| vertex.property(name).is_some());
    let mut model = Model { materials: vec![Material::named("default")], ..Model::default() };
    model.positions.reserve_exact(vertex.count);
    model.normals.reserve_exact(if smooth { vertex.count } else { 0 });
    model.triangles.reserve_exact(checked.triangles);
    let CheckedBody { mut vertices, mut faces, .. } = checked;
    vertices.rows(vertex, &VECTORS, |_, values| {
        model.positions.push(vector(&values[..3]));
        if smooth {
            model.normals.push(vector(&values[3..]));
        }
        Ok(())
    })?;
    let (mut splitter, mut points) = (Splitter::default(), Vec::new());
    faces.rows(face, &CORNERS, |_, lists| {
        let corners = corners(lists);
        points.clear();
        points.extend(corners.iter().map(|&c| model.positions[c as usize]));
        let triangles = splitter.split(&points).iter();
        model.triangles.extend(triangles.map(|triangle| triangle.map(|i| corners[i] as u32)));
        Ok(())
    })?;
    if smooth {
        model.normal_indices = model.triangles.clone();
    }

    let mut notes = Notes::default();
    notes.count(checked.small_faces, SMALL_FACES);
    splitter.note(&mut notes);
    model.notes = notes.into_vec();
    Ok(model)
}

/// The rows of vertices and faces, once all of them have been checked.
struct CheckedBody<'a> {
    /// The body from the first vertex on, and the body from the first face on.
    vertices: Body<'a>,
    faces: Body<'a>,
    triangles: usize,
    /// Faces with fewer than three corners.
    small_faces: usize,
}

/// Checks that all rows fit the header and make a mesh.
fn check<'a>(header: &Header, vertices: usize, mut body: Body<'a>) -> Result<CheckedBody<'a>, Fault> {
    let mut checked = CheckedBody { vertices: body.clone(), faces: body.clone(), triangles: 0, small_faces: 0 };
    let mut faces = 0;
    for element in &header.elements {
        match element.name.as_str() {
            "vertex" => {
                checked.vertices = body.clone();
                body.rows(element, &VECTORS, |number, values| {
                    let [x, y, z] = vector(&values[..3]).to_array();
                    if [x, y, z].iter().all(|coordinate| coordinate.is_finite()) {
                        return Ok(());
                    }
                    let problem = format!("its coordinates ({x:?}, {y:?}, {z:?}) are not finite numbers");
                    Err(Fault::part(format!("vertex {number}"), problem))
                })?;
            }
            "face" => {
                (checked.faces, faces) = (body.clone(), element.count);
                body.rows(element, &CORNERS, |number, lists| {
                    let corners = corners(lists);
                    if let Some(corner) = corners.iter().find(|&&c| c < 0.0 || c >= vertices as f64) {
                        let problem = format!("its corner {corner} is none of the {vertices} vertices");
                        return Err(Fault::part(format!("face {number}"), problem));
                    }
                    checked.small_faces += usize::from(corners.len() < 3);
                    checked.triangles += corners.len().saturating_sub(2);
                    Ok(())
                })?;
            }
            _ => body.rows(element, &[], |_, _| Ok(()))?,
        }
    }
    body.end()?;
    if checked.triangles == 0 {
        let problem =
            format!("it holds no triangles: {vertices} vertices, {faces} faces with fewer than three corners");
        return Err(Fault::part("element face", problem));
    }
    Ok(checked)
}

/// The first number of each column, zero where there is none.
fn vector(columns: &[Vec<f64>]) -> Vec3 {
    Vec3::from_array(std::array::from_fn(|axis| columns[axis].first().map_or(0.0, |&value| value as f32)))
}

/// The list of corners, under either of its names.
fn corners(lists: &[Vec<f64>]) -> &[f64] {
    lists.iter().find(|list| !list.is_empty()).map_or(&[], |list| list)
}
