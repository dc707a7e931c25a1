//! Reads Wavefront OBJ with the crate `tobj`.
//!
//! Vertices and normals keep the order of the file. Unused vertices and normals are dropped.

mod filter;
mod vectors;

use std::io::BufReader;
use std::iter::repeat_n;
use std::mem;
use std::path::Path;

use tobj::{LoadOptions, load_obj_buf};

use self::filter::{Contents, Filter};
use super::error::Fault;
use super::mtl;
use super::notes::Notes;
use super::text::without_byte_order_mark;
use crate::scene::Model;
use crate::scene::polygon::Splitter;

/// `folder` contains the MTL files. A face is flat unless all its corners have normals.
pub(super) fn read(bytes: &[u8], folder: &Path) -> Result<Model, Fault> {
    // tobj would read a byte order mark as a part of the first keyword.
    let mut filter = BufReader::new(Filter::new(without_byte_order_mark(bytes)?));
    let read = load_obj_buf(&mut filter, &LoadOptions::default(), |_| Ok(Default::default()));
    let Filter { mut contents, fault, .. } = filter.into_inner();
    let (parts, _) = read.map_err(|error| fault.unwrap_or_else(|| Fault::file(error.to_string())))?;
    let mut notes = Notes::default();
    contents.check(&mut notes)?;
    let mut model = triangles(parts, &mut contents, &mut notes);
    model.materials = mtl::read(contents.libraries, contents.materials, folder, &mut notes);
    model.notes = notes.into_vec();
    Ok(model)
}

fn triangles(parts: Vec<tobj::Model>, contents: &mut Contents, notes: &mut Notes) -> Model {
    let positions = parts.iter().flat_map(|part| part.mesh.positions.chunks_exact(3));
    let (positions, vertices) = mem::take(&mut contents.vertices).in_file_order(positions);
    let normals = parts.iter().flat_map(|part| part.mesh.normals.chunks_exact(3));
    let (normals, normal_numbers) = mem::take(&mut contents.normals).in_file_order(normals);

    let is_smooth = contents.sections.iter().any(|section| section.is_smooth);
    let has_materials = contents.materials.len() > 1;
    let room = |is_needed: bool| if is_needed { contents.triangles } else { 0 };
    let mut model = Model {
        positions,
        triangles: Vec::with_capacity(contents.triangles),
        normals: if is_smooth { normals } else { vec![] },
        normal_indices: Vec::with_capacity(room(is_smooth)),
        material_of: Vec::with_capacity(room(has_materials)),
        ..Model::default()
    };

    let (mut splitter, mut points) = (Splitter::default(), vec![]);
    let (mut vertices, mut normals) = (&vertices[..], &normal_numbers[..]);
    let mut sections = contents.sections.iter().flat_map(|section| repeat_n(section, section.faces));
    for mesh in parts.into_iter().map(|part| part.mesh) {
        // `face_arities` is empty if all faces are triangles.
        let (mut sizes, mut start) = (mesh.face_arities.iter(), 0);
        while start < mesh.indices.len() {
            let size = sizes.next().map_or(3, |&size| size as usize);
            let section = sections.next().expect("each face is in a section");
            let vertex = |i: usize| vertices[mesh.indices[start + i] as usize];
            points.clear();
            points.extend((0..size).map(|i| model.positions[vertex(i) as usize]));
            for triangle in splitter.split(&points) {
                model.triangles.push(triangle.map(vertex));
                if section.is_smooth {
                    let normal = |i: usize| normals[mesh.normal_indices[start + i] as usize];
                    model.normal_indices.push(triangle.map(normal));
                } else if is_smooth {
                    model.normal_indices.push([Model::FLAT; 3]);
                }
                if has_materials {
                    model.material_of.push(section.material);
                }
            }
            start += size;
        }
        vertices = &vertices[mesh.positions.len() / 3..];
        normals = &normals[mesh.normals.len() / 3..];
    }
    splitter.defects().into_iter().for_each(|(count, defect)| notes.count(count, "polygon", defect));
    model
}
