//! A mesh of a glTF file, in its own space.

use glam::DVec3;

use super::accessors::Accessors;
use super::document::{Mesh, TRIANGLE_FAN, TRIANGLE_STRIP, TRIANGLES};
use crate::scene::load::error::Fault;

pub(super) const NO_MATERIAL: u32 = u32::MAX;

/// The accessors of a mesh, checked but not yet read. Its primitives often share accessors.
#[derive(Default)]
pub(super) struct Shape {
    /// Indices of accessors.
    pub positions: Vec<usize>,
    pub normals: Vec<usize>,
    pub parts: Vec<TriangleAccessors>,
    /// The box of all positions.
    pub bounds: Option<[DVec3; 2]>,
    /// Primitives that are points or lines, or have no positions.
    pub left_out: usize,
    /// Primitives with morph targets.
    pub morphed: usize,
}

pub(super) struct TriangleAccessors {
    /// Index into [`Shape::positions`].
    pub positions: usize,
    /// Index into [`Shape::normals`]; that accessor is as long as the positions.
    pub normals: Option<usize>,
    /// The accessor of vertex indices; none if the corners are the vertices in order.
    corners: Option<usize>,
    /// The number of corners.
    count: usize,
    mode: u32,
    pub material: u32,
}

impl Shape {
    /// Checks the triangles of a mesh and their accessors.
    pub fn check(number: usize, mesh: &Mesh, accessors: &Accessors) -> Result<Self, Fault> {
        let mut shape = Self::default();
        for (i, primitive) in mesh.primitives.iter().enumerate() {
            let fault = |problem: String| Fault::part(format!("mesh {number}, primitive {i}"), problem);
            let Some(position) = primitive.attributes.position.filter(|_| primitive.mode >= TRIANGLES) else {
                shape.left_out += 1;
                continue;
            };
            let [min, max] = accessors.check_positions(position)?;
            let [all_min, all_max] = shape.bounds.unwrap_or([min, max]);
            shape.bounds = Some([all_min.min(min), all_max.max(max)]);
            let vertices = accessors.count(position);
            let positions = place(&mut shape.positions, position);

            let normals = match primitive.attributes.normal {
                None => None,
                Some(normal) if accessors.count(normal) != vertices => {
                    let problem = format!("it has {} normals for {vertices} vertices", accessors.count(normal));
                    return Err(fault(problem));
                }
                Some(normal) => {
                    accessors.check_vectors(normal)?;
                    Some(place(&mut shape.normals, normal))
                }
            };
            let corners = primitive.indices;
            if let Some(accessor) = corners
                && let Some((number, index)) = accessors.check_indices(accessor)?
                && index as usize >= vertices
            {
                let problem = format!("its index {number} names vertex {index}, but there are only {vertices}");
                return Err(fault(problem));
            }
            let count = corners.map_or(vertices, |accessor| accessors.count(accessor));
            if primitive.mode == TRIANGLES && count % 3 != 0 {
                return Err(fault(format!("its {count} corners do not make whole triangles")));
            }
            shape.morphed += usize::from(!primitive.targets.is_empty());
            let material = primitive.material.map_or(NO_MATERIAL, |material| material as u32);
            shape.parts.push(TriangleAccessors { positions, normals, corners, count, mode: primitive.mode, material });
        }
        Ok(shape)
    }

    /// The numbers of vertices, normals and triangles.
    pub fn sizes(&self, accessors: &Accessors) -> [usize; 3] {
        let total = |list: &[usize]| list.iter().map(|&n| accessors.count(n)).fold(0, usize::saturating_add);
        let triangles = self.parts.iter().map(TriangleAccessors::triangles).fold(0, usize::saturating_add);
        [total(&self.positions), total(&self.normals), triangles]
    }
}

/// The index of an accessor in a list; adds it if it is missing.
fn place(list: &mut Vec<usize>, accessor: usize) -> usize {
    list.iter().position(|&other| other == accessor).unwrap_or_else(|| {
        list.push(accessor);
        list.len() - 1
    })
}

impl TriangleAccessors {
    fn triangles(&self) -> usize {
        if self.mode == TRIANGLES { self.count / 3 } else { self.count.saturating_sub(2) }
    }

    /// Calls `take` with the vertex indices of each triangle.
    pub fn for_each(&self, accessors: &Accessors, mut take: impl FnMut([u32; 3])) {
        let corners: Box<dyn Iterator<Item = u32>> = match self.corners {
            Some(accessor) => Box::new(accessors.indices(accessor)),
            None => Box::new(0..self.count as u32),
        };
        let [mut a, mut b] = [0; 2];
        for (i, c) in corners.enumerate() {
            let last = match self.mode {
                TRIANGLE_STRIP if i % 2 == 1 => [a, c, b],
                _ => [a, b, c],
            };
            if i % 3 == 2 || i > 2 && self.mode != TRIANGLES {
                take(last);
            }
            match self.mode {
                TRIANGLE_STRIP => [a, b] = [b, c],
                TRIANGLE_FAN if i == 0 => a = c,
                TRIANGLE_FAN => b = c,
                _ if i % 3 == 0 => a = c,
                _ => b = c,
            }
        }
    }
}
