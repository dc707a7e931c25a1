//! glTF 2.0, as text with separate buffers or as one binary file.

mod accessors;
mod buffers;
mod document;
mod graph;
mod shape;
mod text;

use std::collections::HashSet;
use std::path::Path;

use glam::{DMat3, DVec3, Vec3};

use self::accessors::Accessors;
use self::document::Document;
use self::graph::Placement;
use self::shape::Shape;
use super::error::Fault;
use super::notes::Notes;
use crate::scene::{Material, Model};

/// A scene may have this many triangles, and vertices, more than its files have bytes. Without shared meshes it cannot
/// have more than there are bytes.
const MOST_REPEATED: usize = 1 << 24;

/// Reads a glTF file and expands its node graph: every mesh once for each node that shows it.
///
/// Transforms are multiplied in f64 and rounded once, when they are applied to vertices. Triangles of mirrored nodes
/// are reversed, so that they keep their front side. Points, lines, textures, skins and morph targets are left out.
/// Everything visible is checked and counted before anything is read.
pub(super) fn read(bytes: Vec<u8>, folder: &Path) -> Result<Model, Fault> {
    let (mut document, chunk) = text::parse(&bytes)?;
    let (size, chunk) = (bytes.len(), chunk.map(<[u8]>::to_vec));
    drop(bytes);
    let buffers = buffers::read(&mut document.buffers, chunk, folder)?;
    let size = size + buffers::size(&buffers);
    let placements = graph::placements(&document)?;
    let accessors = Accessors::new(&document, &buffers);
    let mut shapes: Vec<Option<Shape>> = document.meshes.iter().map(|_| None).collect();
    for &Placement { mesh, .. } in &placements {
        if shapes[mesh].is_none() {
            shapes[mesh] = Some(Shape::check(mesh, &document.meshes[mesh], &accessors)?);
        }
    }

    let mut model = Model::default();
    let shown = || placements.iter().filter_map(|p| shapes[p.mesh].as_ref().map(|shape| (p, shape)));
    shown().try_for_each(|(placement, shape)| check_place(placement, shape, &accessors))?;
    let sizes = shown().map(|(_, shape)| shape.sizes(&accessors));
    reserve(&mut model, sizes, size, || nothing(&document, &placements, &shapes))?;
    for (placement, shape) in shown() {
        add(&mut model, placement, shape, &accessors);
    }

    // Drop redundant data.
    if model.normals.is_empty() {
        model.normal_indices = Vec::new();
    }
    let used: HashSet<u32> = model.material_of.iter().copied().collect();
    let numbered = (0_u32..).zip(&document.materials);
    let textured = numbered.filter(|(number, material)| used.contains(number) && material.is_textured()).count();
    model.materials = document.materials.iter().enumerate().map(material).collect();
    let default = model.materials.len() as u32;
    if model.material_of.contains(&shape::NO_MATERIAL) || model.materials.is_empty() {
        model.materials.push(Material::named("default"));
        model.material_of.iter_mut().filter(|m| **m == shape::NO_MATERIAL).for_each(|m| *m = default);
    }
    if model.material_of.iter().all(|&m| m == 0) {
        model.material_of = Vec::new();
    }

    let mut notes = Notes::default();
    let skinned = document.nodes.iter().filter(|node| node.skin.is_some() && node.mesh.is_some()).count();
    let sum = |count: fn(&Shape) -> usize| shapes.iter().flatten().map(count).sum();
    notes.count(skinned, ["node has a skin: it stands unposed", "nodes have a skin: they stand unposed"]);
    let texture = [
        "material has a texture, which is left out: it shows its base colour as it is",
        "materials have textures, which are left out: they show their base colour as it is",
    ];
    notes.count(textured, texture);
    let morph = [
        "primitive has morph targets, which are left out: it keeps its basic form",
        "primitives have morph targets, which are left out: they keep their basic form",
    ];
    notes.count(sum(|s| s.morphed), morph);
    let left_out = [
        "primitive is points or lines, or has no positions: it is left out",
        "primitives are points or lines, or have no positions: they are left out",
    ];
    notes.count(sum(|s| s.left_out), left_out);
    model.notes = notes.into_vec();
    Ok(model)
}

/// Checks that all vertices are finite after the transform of a node.
fn check_place(placement: &Placement, shape: &Shape, accessors: &Accessors) -> Result<(), Fault> {
    let place = |p: DVec3| placement.transform.transform_point3(p).as_vec3();
    let Some(bounds) = shape.bounds else { return Ok(()) };
    let corner = |i: usize| DVec3::new(bounds[i & 1].x, bounds[i >> 1 & 1].y, bounds[i >> 2].z);
    if (0..8).all(|i| place(corner(i)).is_finite()) {
        return Ok(());
    }
    for &accessor in &shape.positions {
        for (number, position) in accessors.vectors(accessor).enumerate() {
            let placed = place(position.as_dvec3());
            if !placed.is_finite() {
                let problem = format!(
                    "it places vertex {number} of mesh {} at {:?}, which is not finite: scale it down",
                    placement.mesh,
                    placed.to_array()
                );
                return Err(Fault::part(format!("node {}", placement.node), problem));
            }
        }
    }
    Ok(())
}

/// Allocates the memory for the whole scene before anything is expanded: a small file can show a large mesh very often.
fn reserve(
    model: &mut Model,
    shapes: impl Iterator<Item = [usize; 3]>,
    bytes: usize,
    nothing: impl Fn() -> String,
) -> Result<(), Fault> {
    let mut sizes = [0_usize; 3];
    for shape in shapes {
        for (sum, size) in sizes.iter_mut().zip(shape) {
            *sum = sum.saturating_add(size);
        }
    }
    let [vertices, normals, triangles] = sizes;
    if triangles == 0 {
        return Err(Fault::file(format!("it holds no triangles that are shown: {}", nothing())));
    }
    let most = bytes.saturating_add(MOST_REPEATED).min(u32::MAX as usize - 1);
    let fits = vertices.max(normals).max(triangles) <= most
        && model.positions.try_reserve_exact(vertices).is_ok()
        && model.normals.try_reserve_exact(normals).is_ok()
        && model.triangles.try_reserve_exact(triangles).is_ok()
        && model.normal_indices.try_reserve_exact(triangles).is_ok()
        && model.material_of.try_reserve_exact(triangles).is_ok();
    if fits {
        return Ok(());
    }
    let shown = format!("its nodes show {triangles} triangles and {vertices} vertices");
    Err(Fault::file(format!("{shown}, and more than {most} do not fit from files of {bytes} bytes: split the scene")))
}

fn nothing(document: &Document, placements: &[Placement], shapes: &[Option<Shape>]) -> String {
    let default = document.scene.map(|number| (number, &document.scenes[number].nodes[..]));
    match default {
        _ if shapes.iter().flatten().any(|shape| !shape.parts.is_empty()) => {
            "its primitives have too few corners for a triangle".into()
        }
        _ if !placements.is_empty() && placements.iter().all(|p| document.meshes[p.mesh].primitives.is_empty()) => {
            "its meshes have no primitives".into()
        }
        _ if !placements.is_empty() => "its meshes have only points, lines or primitives without positions".into(),
        _ if document.meshes.is_empty() => "it has no meshes".into(),
        Some((scene, [])) => format!("scene {scene}, its default, has no nodes"),
        _ if document.nodes.is_empty() => {
            format!("it has no nodes, which would show its meshes, {}", document.meshes.len())
        }
        Some((scene, _)) => format!("no node of scene {scene}, its default, has a mesh"),
        None => "no node has a mesh".into(),
    }
}

fn add(model: &mut Model, placement: &Placement, shape: &Shape, accessors: &Accessors) {
    let transform = placement.transform;
    let linear = DMat3::from_mat4(transform);
    let mirrored = linear.determinant() < 0.0;
    let to_normal = normal_matrix(linear);

    let place = |p: Vec3| transform.transform_point3(p.as_dvec3()).as_vec3();
    let first = |list: &mut Vec<Vec3>, added: &mut dyn Iterator<Item = Vec3>| {
        let first = list.len() as u32;
        list.extend(added);
        first
    };
    let vertices = shape.positions.iter();
    let first_vertex: Vec<u32> =
        vertices.map(|&a| first(&mut model.positions, &mut accessors.vectors(a).map(place))).collect();
    let turn = |n: Vec3| (to_normal * n.as_dvec3()).normalize_or_zero().as_vec3();
    let normals = shape.normals.iter();
    let first_normal: Vec<u32> =
        normals.map(|&a| first(&mut model.normals, &mut accessors.vectors(a).map(turn))).collect();

    for part in &shape.parts {
        part.for_each(accessors, |corners| {
            let corners = Model::placed(corners, mirrored);
            model.triangles.push(corners.map(|i| first_vertex[part.positions] + i));
            model.normal_indices.push(match part.normals {
                Some(normals) => corners.map(|i| first_normal[normals] + i),
                None => [Model::FLAT; 3],
            });
            model.material_of.push(part.material);
        });
    }
}

/// The inverse transpose up to a positive factor: the cofactor matrix, which exists even without an inverse.
fn normal_matrix(linear: DMat3) -> DMat3 {
    let DMat3 { x_axis: x, y_axis: y, z_axis: z } = linear;
    let sign = if linear.determinant() < 0.0 { -1.0 } else { 1.0 };
    DMat3::from_cols(y.cross(z), z.cross(x), x.cross(y)) * sign
}

/// Uses the base colour as diffuse colour; the course's shading has no metals and no roughness.
fn material((number, read): (usize, &document::Material)) -> Material {
    let name = read.name.clone().unwrap_or_else(|| format!("material {number}"));
    let [r, g, b, _] = read.pbr_metallic_roughness.base_color_factor.unwrap_or([1.0; 4]);
    Material { diffuse: Vec3::new(r, g, b).clamp(Vec3::ZERO, Vec3::ONE), ..Material::named(name) }
}
