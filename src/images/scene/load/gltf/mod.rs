//! Reads glTF 2.0 files, text or binary.

mod accessors;
mod buffers;
mod extensions;
mod graph;
mod placement;
mod shape;
mod text;

use std::collections::hash_map::Entry;
use std::collections::{HashMap, HashSet};
use std::num::Saturating;
use std::path::Path;

use glam::{DMat3, DMat4, DVec3, Vec3};
use gltf::Document;

use self::accessors::Accessors;
use self::placement::Placement;
use self::shape::Shape;
use super::error::Fault;
use crate::scene::{Material, Model};

/// Each count that `reserve` receives may exceed the bytes of the files by this number. Shared meshes and accessors can
/// make more triangles than the files have bytes.
const EXTRA_ELEMENTS: usize = 1 << 24;

/// Vertices are transformed in `f64` and rounded to `f32` once.
pub(super) fn read(mut bytes: Vec<u8>, folder: &Path) -> Result<Model, Fault> {
    let (text::Document { mut root, instances, textured, mut notes }, chunk) = text::parse(&bytes)?;
    let size = bytes.len();
    let chunk = chunk.map(|chunk| {
        bytes.truncate(chunk.end);
        bytes.drain(..chunk.start);
        bytes
    });
    let buffers = buffers::read(&mut root.buffers, chunk, folder)?;
    let size = size + buffers::size(&buffers);
    let document = Document::from_json_without_validation(root);
    let accessors = Accessors::new(&document, &buffers)?;
    let (shown, worlds) = graph::walk(&document)?;
    let with_mesh = shown.into_iter().filter_map(|node| Some((node.mesh()?, instances[node.index()], node)));
    let placements: Vec<Placement> =
        with_mesh.map(|(mesh, instances, node)| Placement { mesh, instances, node }).collect();
    let mut shapes = HashMap::new();
    let mut sizes = [Saturating(0); 4];
    for placement in &placements {
        let mesh = placement.mesh.index();
        if let Entry::Vacant(shape) = shapes.entry(mesh) {
            shape.insert(Shape::count(&placement.mesh)?);
        }
        let copies = Saturating(placement.copies(accessors)?);
        for (total, size) in sizes.iter_mut().zip(shapes[&mesh].sizes) {
            *total += size * copies;
        }
        sizes[3] += copies;
    }
    let mut model = Model { materials: document.materials().enumerate().map(material).collect(), ..Model::default() };
    if sizes[2].0 == 0 {
        let problem = "its nodes show no triangle primitive with positions and at least three corners";
        return Err(Fault::file(format!("it has no visible triangles: {problem}")));
    }
    reserve(&mut model, sizes.map(|size| size.0), size)?;
    for placement in &placements {
        for transform in placement.transforms(&worlds, accessors)? {
            add(&mut model, placement, transform, &shapes[&placement.mesh.index()], accessors)?;
        }
    }

    if model.normals.is_empty() {
        model.normal_indices = Vec::new();
    }
    let used: HashSet<u32> = model.material_of.iter().copied().collect();
    // A part without a material has the material index `model.materials.len()`.
    if used.contains(&(model.materials.len() as u32)) {
        model.materials.push(Material::named("default"));
    }
    if used == HashSet::from([0]) {
        model.material_of = Vec::new();
    }

    let skinned = placements.iter().filter(|placement| placement.node.skin().is_some()).count();
    notes.count(skinned, "node", "with a skin: its mesh is placed by the first joint and not bent");
    let textured = (0..).zip(&textured).filter(|(number, is_textured)| **is_textured && used.contains(number)).count();
    notes.count(textured, "material", "with a texture, which is ignored: the base colour is used");
    let parts = shapes.values().flat_map(|shape| &shape.parts);
    let morphed = parts.filter(|part| part.primitive.morph_targets().len() > 0).count();
    notes.count(morphed, "primitive", "with morph targets, which are ignored");
    let left_out = shapes.values().map(|shape| shape.left_out).sum();
    notes.count(left_out, "primitive", "of points or lines or without positions: ignored");
    model.notes = notes.into_vec();
    Ok(model)
}

/// Rejects a model with too many elements. A small file can show a large mesh many times. Call `reserve` before `add`.
///
/// `sizes` are the counts of vertices, normals, triangles and other elements, which are parts and instances.
fn reserve(model: &mut Model, sizes: [usize; 4], bytes: usize) -> Result<(), Fault> {
    let [vertices, normals, triangles, others] = sizes;
    let most = bytes.saturating_add(EXTRA_ELEMENTS).min(u32::MAX as usize - 1);
    if sizes.iter().all(|&size| size <= most) && model.try_reserve(vertices, normals, triangles).is_ok() {
        return Ok(());
    }
    let shown = format!("its nodes instantiate {triangles} triangles and {vertices} vertices");
    let shown = format!("{shown}, with {normals} normals and {others} other elements");
    let limit = format!("the limit for files of {bytes} bytes is {most} of each, if memory suffices");
    Err(Fault::file(format!("{shown}, but {limit}: split the scene")))
}

fn add(
    model: &mut Model,
    placement: &Placement,
    transform: DMat4,
    shape: &Shape,
    accessors: Accessors,
) -> Result<(), Fault> {
    let mut first_vertices = Vec::new();
    for &accessor in &shape.positions {
        let first = model.positions.len();
        first_vertices.push(first as u32);
        let placed = |position| transform.transform_point3(DVec3::from_array(position)).as_vec3();
        model.positions.extend(accessors.read(accessor)?.map(placed));
        if let Some(number) = model.positions[first..].iter().position(|placed| !placed.is_finite()) {
            let (mesh, placed) = (placement.mesh.index(), model.positions[first + number].to_array());
            let problem = format!("it places vertex {number} of mesh {mesh} at {placed:?}, which is not finite");
            return Err(Fault::part(format!("node {}", placement.node.index()), problem + ": scale it down"));
        }
    }
    let mut first_normals = Vec::new();
    let to_normal = to_normal(DMat3::from_mat4(transform));
    for &accessor in &shape.normals {
        first_normals.push(model.normals.len() as u32);
        let turned = |normal| (to_normal * DVec3::from_array(normal)).normalize_or_zero().as_vec3();
        model.normals.extend(accessors.read(accessor)?.map(turned));
    }
    let is_mirrored = transform.determinant() < 0.0;
    for part in &shape.parts {
        let material = part.primitive.material().index().unwrap_or(model.materials.len());
        for corners in part.triangles(accessors)? {
            let corners = Model::placed(corners, is_mirrored);
            model.triangles.push(corners.map(|i| first_vertices[part.positions] + i));
            let flat = [Model::FLAT; 3];
            model.normal_indices.push(part.normals.map_or(flat, |normals| corners.map(|i| first_normals[normals] + i)));
            model.material_of.push(material as u32);
        }
    }
    Ok(())
}

/// Returns a positive multiple of the inverse transpose of `linear`. The function uses the cofactor matrix,
/// because a singular `linear` has no inverse.
fn to_normal(linear: DMat3) -> DMat3 {
    let DMat3 { x_axis: x, y_axis: y, z_axis: z } = linear;
    let sign = if linear.determinant() < 0.0 { -1.0 } else { 1.0 };
    DMat3::from_cols(y.cross(z), z.cross(x), x.cross(y)) * sign
}

/// The base colour becomes the diffuse colour.
fn material((number, read): (usize, gltf::Material)) -> Material {
    let name = read.name().map_or_else(|| format!("material {number}"), str::to_owned);
    let [r, g, b, _] = read.pbr_metallic_roughness().base_color_factor();
    Material { diffuse: Vec3::new(r, g, b).clamp(Vec3::ZERO, Vec3::ONE), ..Material::named(name) }
}
