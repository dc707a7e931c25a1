//! glTF 2.0, as text with its buffers apart or as one binary file.

mod accessors;
mod graph;
mod shape;
mod source;

use std::path::Path;

use glam::{DMat3, Vec3};

use self::accessors::Accessors;
use self::graph::Placement;
use self::shape::Shape;
use super::error::Fault;
use crate::scene::{Material, Model};

/// Reads a glTF file and expands its node graph: every mesh once for each node that shows it.
///
/// Transforms are multiplied in f64 and rounded once, when they meet the vertices. Triangles of mirrored nodes are turned
/// round, so that they face the side that they face in the file. Points, lines, textures, skins and morph targets are
/// left out.
pub(super) fn read(bytes: &[u8], folder: &Path) -> Result<Model, Fault> {
    let (document, buffers) = source::open(bytes, folder)?;
    let placements = graph::placements(document.as_json())?;
    let accessors = Accessors { buffers: &buffers };
    let meshes: Vec<_> = document.meshes().collect();
    let mut shapes: Vec<Option<Shape>> = meshes.iter().map(|_| None).collect();
    for placement in &placements {
        let shape = &mut shapes[placement.mesh];
        if shape.is_none() {
            *shape = Some(Shape::read(&meshes[placement.mesh], &accessors)?);
        }
    }

    let mut model = Model::default();
    let shown = || placements.iter().filter_map(|p| shapes[p.mesh].as_ref().map(|shape| (p, shape)));
    reserve(&mut model, shown().map(|(_, shape)| shape))?;
    for (placement, shape) in shown() {
        add(&mut model, placement, shape);
    }

    // Drop what says nothing.
    if model.normals.is_empty() {
        model.normal_indices = Vec::new();
    }
    model.materials = document.materials().map(material).collect();
    let default = model.materials.len() as u32;
    if model.material_of.contains(&shape::NO_MATERIAL) || model.materials.is_empty() {
        model.materials.push(Material::named("default"));
        model.material_of.iter_mut().filter(|m| **m == shape::NO_MATERIAL).for_each(|m| *m = default);
    }
    if model.material_of.iter().all(|&m| m == 0) {
        model.material_of = Vec::new();
    }
    let skinned = document.nodes().filter(|node| node.skin().is_some() && node.mesh().is_some()).count();
    if skinned > 0 {
        model.notes.push(format!("{skinned} nodes have a skin: they stand unposed"));
    }
    Ok(model)
}

/// A small file can show a large mesh very often: takes the memory for all of it before anything is expanded.
fn reserve<'a>(model: &mut Model, shapes: impl Iterator<Item = &'a Shape>) -> Result<(), Fault> {
    let mut sizes = [0_usize; 3];
    for shape in shapes {
        for (sum, size) in sizes.iter_mut().zip(shape.sizes()) {
            *sum = sum.saturating_add(size);
        }
    }
    let [vertices, normals, triangles] = sizes;
    let fits = vertices.max(normals).max(triangles) < u32::MAX as usize
        && model.positions.try_reserve_exact(vertices).is_ok()
        && model.normals.try_reserve_exact(normals).is_ok()
        && model.triangles.try_reserve_exact(triangles).is_ok()
        && model.normal_indices.try_reserve_exact(triangles).is_ok()
        && model.material_of.try_reserve_exact(triangles).is_ok();
    if fits {
        return Ok(());
    }
    Err(Fault::file(format!("its nodes show {triangles} triangles and {vertices} vertices, too many: split the scene")))
}

fn add(model: &mut Model, placement: &Placement, shape: &Shape) {
    let transform = placement.transform;
    let linear = DMat3::from_mat4(transform);
    let mirrored = linear.determinant() < 0.0;
    let first_vertex: Vec<u32> = starts(model.positions.len(), &shape.positions);
    let first_normal: Vec<u32> = starts(model.normals.len(), &shape.normals);
    let to_normal = normal_matrix(linear);

    let place = |&p: &Vec3| transform.transform_point3(p.as_dvec3()).as_vec3();
    model.positions.extend(shape.positions.iter().flatten().map(place));
    let turn = |&n: &Vec3| (to_normal * n.as_dvec3()).normalize_or_zero().as_vec3();
    model.normals.extend(shape.normals.iter().flatten().map(turn));

    for part in &shape.parts {
        for &[a, b, c] in &part.triangles {
            let corners = if mirrored { [a, c, b] } else { [a, b, c] };
            model.triangles.push(corners.map(|i| first_vertex[part.positions] + i));
            model.normal_indices.push(match part.normals {
                Some(normals) => corners.map(|i| first_normal[normals] + i),
                None => [Model::FLAT; 3],
            });
            model.material_of.push(part.material);
        }
    }
}

/// Where each of `lists` begins when they are put one after the other behind `start` elements.
fn starts(start: usize, lists: &[Vec<Vec3>]) -> Vec<u32> {
    let begin = |next: &mut usize, list: &Vec<Vec3>| {
        let begin = *next as u32;
        *next += list.len();
        Some(begin)
    };
    lists.iter().scan(start, begin).collect()
}

/// The inverse transpose but for a positive factor: the cofactors, which also exist when there is no inverse.
fn normal_matrix(linear: DMat3) -> DMat3 {
    let DMat3 { x_axis: x, y_axis: y, z_axis: z } = linear;
    let sign = if linear.determinant() < 0.0 { -1.0 } else { 1.0 };
    DMat3::from_cols(y.cross(z), z.cross(x), x.cross(y)) * sign
}

/// The base colour is taken for the diffuse one; metals and roughness have no place in the course's shading.
fn material(read: gltf::Material) -> Material {
    let number = read.index().unwrap_or_default();
    let name = read.name().map_or_else(|| format!("material {number}"), str::to_owned);
    let [r, g, b, _] = read.pbr_metallic_roughness().base_color_factor();
    Material { diffuse: Vec3::new(r, g, b).clamp(Vec3::ZERO, Vec3::ONE), ..Material::named(name) }
}
