//! A mesh of a glTF file, in object space.

use std::num::Saturating;

use gltf::mesh::Mode;
use gltf::{Mesh, Primitive, Semantic};
use indexmap::IndexSet;

use super::accessors::Accessors;
use crate::scene::load::error::Fault;

#[derive(Default)]
pub(super) struct Shape<'a> {
    /// The numbers of accessors. Primitives often share accessors.
    pub positions: IndexSet<usize>,
    pub normals: IndexSet<usize>,
    pub parts: Vec<Part<'a>>,
    /// The counts of vertices, normals, triangles and primitives.
    pub sizes: [Saturating<usize>; 4],
    pub left_out: usize,
}

pub(super) struct Part<'a> {
    pub primitive: Primitive<'a>,
    mesh: usize,
    vertices: usize,
    /// Index into [`Shape::positions`].
    pub positions: usize,
    /// Index into [`Shape::normals`].
    pub normals: Option<usize>,
}

impl<'a> Shape<'a> {
    pub fn count(mesh: &Mesh<'a>) -> Result<Self, Fault> {
        let mut shape = Self::default();
        for primitive in mesh.primitives() {
            let is_surface = !matches!(primitive.mode(), Mode::Points | Mode::Lines | Mode::LineLoop | Mode::LineStrip);
            match primitive.get(&Semantic::Positions).filter(|_| is_surface) {
                Some(positions) => shape.add(mesh.index(), primitive, positions.index(), positions.count())?,
                None => shape.left_out += 1,
            }
        }
        Ok(shape)
    }

    fn add(&mut self, mesh: usize, primitive: Primitive<'a>, positions: usize, vertices: usize) -> Result<(), Fault> {
        let attribute = |semantic: Semantic| match primitive.get(&semantic) {
            Some(accessor) if accessor.count() != vertices => {
                let (name, count) = (semantic.to_string(), accessor.count());
                Err(fault(mesh, &primitive, format!("its {name} has {count} elements for {vertices} vertices")))
            }
            accessor => Ok(accessor.map(|accessor| accessor.index())),
        };
        let normals = attribute(Semantic::Normals)?;
        let corners = primitive.indices().map_or(vertices, |indices| indices.count());
        let is_list = primitive.mode() == Mode::Triangles;
        if is_list && !corners.is_multiple_of(3) {
            return Err(fault(mesh, &primitive, format!("its {corners} corners do not make whole triangles")));
        }

        self.sizes[2] += if is_list { corners / 3 } else { corners.saturating_sub(2) };
        // Count the primitive, because even a primitive without triangles takes time to read.
        self.sizes[3] += 1;
        let mut add = |accessor, kind: usize| {
            let list = if kind == 0 { &mut self.positions } else { &mut self.normals };
            let (index, is_new) = list.insert_full(accessor);
            self.sizes[kind] += if is_new { vertices } else { 0 };
            index
        };
        let positions = add(positions, 0);
        let normals = normals.map(|normals| add(normals, 1));
        self.parts.push(Part { primitive, mesh, vertices, positions, normals });
        Ok(())
    }
}

impl<'a> Part<'a> {
    pub fn triangles(&self, accessors: Accessors<'a>) -> Result<Vec<[u32; 3]>, Fault> {
        let corners: Vec<u32> = match self.primitive.indices() {
            Some(indices) => accessors.read(indices.index())?.map(|[index]| index as u32).collect(),
            None => (0..self.vertices as u32).collect(),
        };
        if let Some(i) = corners.iter().position(|&vertex| vertex as usize >= self.vertices) {
            let problem = format!("its index {i} names vertex {}, but there are only {}", corners[i], self.vertices);
            return Err(fault(self.mesh, &self.primitive, problem));
        }
        Ok(match self.primitive.mode() {
            Mode::TriangleStrip => {
                let turned = |(i, c): (usize, &[u32])| if i % 2 == 0 { [c[0], c[1], c[2]] } else { [c[0], c[2], c[1]] };
                corners.windows(3).enumerate().map(turned).collect()
            }
            Mode::TriangleFan => corners.windows(2).skip(1).map(|c| [corners[0], c[0], c[1]]).collect(),
            _ => corners.as_chunks().0.to_vec(),
        })
    }
}

fn fault(mesh: usize, primitive: &Primitive, problem: String) -> Fault {
    Fault::part(format!("mesh {mesh}, primitive {}", primitive.index()), problem)
}
