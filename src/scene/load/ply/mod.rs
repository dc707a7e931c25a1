//! PLY, the Stanford polygon format (Turk 1994), ASCII and binary.

mod body;
mod header;
mod row;

use glam::Vec3;

use self::body::Body;
use self::row::{Face, Skipped, Vertex};
use super::error::Fault;
use crate::scene::{Material, Model};

/// Reads a PLY file: the positions and, if there are any, normals of its vertices, and its faces as fans.
pub(super) fn read(bytes: &[u8]) -> Result<Model, Fault> {
    let (header, body) = header::split(bytes)?;
    header::check(&header)?;
    let vertex = &header.elements["vertex"];
    let smooth = ["nx", "ny", "nz"].iter().all(|name| vertex.properties.contains_key(*name));

    let mut model = Model { materials: vec![Material::named("default")], ..Model::default() };
    let mut body = Body::new(body, header.encoding);
    let mut thin_faces = 0;
    for (name, element) in &header.elements {
        match name.as_str() {
            "vertex" => body.rows(element, |_, vertex: Vertex| {
                model.positions.push(Vec3::from(vertex.position));
                if smooth {
                    model.normals.push(Vec3::from(vertex.normal));
                }
                Ok(())
            })?,
            "face" => body.rows(element, |number, Face { corners }| {
                if let Some(corner) = corners.iter().find(|&&c| c < 0 || c >= vertex.count as i64) {
                    let problem = format!("its corner {corner} is none of the {} vertices", vertex.count);
                    return Err(Fault::part(format!("face {number}"), problem));
                }
                thin_faces += usize::from(corners.len() < 3);
                let fan = corners.windows(2).skip(1).map(|pair| [corners[0], pair[0], pair[1]].map(|c| c as u32));
                model.triangles.extend(fan);
                Ok(())
            })?,
            _ => body.rows(element, |_, _: Skipped| Ok(()))?,
        }
    }
    body.end()?;

    if smooth {
        model.normal_indices = model.triangles.clone();
    }
    if thin_faces > 0 {
        model.notes.push(format!("{thin_faces} faces with fewer than three corners are left out"));
    }
    Ok(model)
}
