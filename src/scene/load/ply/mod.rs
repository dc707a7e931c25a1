//! PLY, the Stanford polygon format (Turk 1994), ASCII and binary.

mod body;
mod header;
mod row;

use glam::Vec3;
use ply_rs_bw::ply::Header;

use self::body::Body;
use self::row::{Face, Skipped, Vertex};
use super::error::Fault;
use super::notes::Notes;
use super::polygon::Splitter;
use crate::scene::{Material, Model};

/// Reads a PLY file: the positions and, if there are any, normals of its vertices, and the triangles of its faces.
///
/// All rows are gone through twice: first nothing is kept and everything is checked, so that a file that is refused
/// takes no memory but its own.
pub(super) fn read(bytes: &[u8]) -> Result<Model, Fault> {
    let (header, body, line_end) = header::split(bytes)?;
    header::check(&header)?;
    let found = check(&header, Body::new(body, header.encoding, line_end))?;

    let vertex = &header.elements["vertex"];
    let smooth = ["nx", "ny", "nz"].iter().all(|name| vertex.properties.contains_key(*name));
    let mut model = Model { materials: vec![Material::named("default")], ..Model::default() };
    model.positions.reserve_exact(vertex.count);
    model.normals.reserve_exact(if smooth { vertex.count } else { 0 });
    model.triangles.reserve_exact(found.triangles);
    let Found { mut vertices, mut faces, .. } = found;
    vertices.rows(vertex, |_, vertex: Vertex| {
        model.positions.push(Vec3::from(vertex.position));
        if smooth {
            model.normals.push(Vec3::from(vertex.normal));
        }
        Ok(())
    })?;
    let (mut splitter, mut points) = (Splitter::default(), Vec::new());
    faces.rows(&header.elements["face"], |_, Face { corners }| {
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
    notes.count(found.thin_faces, "faces with fewer than three corners are left out");
    splitter.tell(&mut notes);
    model.notes = notes.into_vec();
    Ok(model)
}

/// What the rows of a file hold.
struct Found<'a> {
    /// The body from the first vertex on, and from the first face on.
    vertices: Body<'a>,
    faces: Body<'a>,
    triangles: usize,
    thin_faces: usize,
}

/// Whether all rows are what the header declares and make a mesh.
fn check<'a>(header: &Header, mut body: Body<'a>) -> Result<Found<'a>, Fault> {
    let mut found = Found { vertices: body.clone(), faces: body.clone(), triangles: 0, thin_faces: 0 };
    let vertices = header.elements["vertex"].count;
    for (name, element) in &header.elements {
        match name.as_str() {
            "vertex" => {
                found.vertices = body.clone();
                body.rows(element, |number, Vertex { position: [x, y, z], .. }| {
                    if [x, y, z].iter().all(|coordinate| coordinate.is_finite()) {
                        return Ok(());
                    }
                    let problem = format!("its coordinates ({x:?}, {y:?}, {z:?}) are not finite numbers");
                    Err(Fault::part(format!("vertex {number}"), problem))
                })?;
            }
            "face" => {
                found.faces = body.clone();
                body.rows(element, |number, Face { corners }| {
                    if let Some(corner) = corners.iter().find(|&&c| c < 0 || c >= vertices as i64) {
                        let problem = format!("its corner {corner} is none of the {vertices} vertices");
                        return Err(Fault::part(format!("face {number}"), problem));
                    }
                    found.thin_faces += usize::from(corners.len() < 3);
                    found.triangles += corners.len().saturating_sub(2);
                    Ok(())
                })?;
            }
            _ => body.rows(element, |_, _: Skipped| Ok(()))?,
        }
    }
    body.end()?;
    if found.triangles == 0 {
        let faces = header.elements["face"].count;
        let problem =
            format!("it holds no triangles: {vertices} vertices, {faces} faces with fewer than three corners");
        return Err(Fault::part("element face", problem));
    }
    Ok(found)
}
