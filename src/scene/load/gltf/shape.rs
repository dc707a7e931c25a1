//! A mesh of a glTF file, in its own space.

use gltf::mesh::Mode;
use gltf::{Mesh, Primitive, Semantic};
use indexmap::IndexSet;

use super::accessors::Accessors;
use crate::scene::load::error::Fault;

/// A mesh whose accessors are counted, but not yet read. Its primitives often share accessors.
#[derive(Default)]
pub(super) struct Shape<'a> {
    pub positions: IndexSet<Attribute>,
    pub normals: IndexSet<Attribute>,
    pub parts: Vec<Part<'a>>,
    /// The numbers of vertices, normals and triangles, and of what else is read to place them.
    pub sizes: [usize; 4],
    /// Primitives that are points or lines, or have no positions.
    pub left_out: usize,
    /// Primitives with morph targets.
    pub morphed: usize,
}

/// The accessors of vectors, and of the sets of joints and weights by which a skin moves them; all of one length.
#[derive(PartialEq, Eq, Hash)]
pub(super) struct Attribute {
    pub vectors: usize,
    pub influences: Vec<[usize; 2]>,
    pub count: usize,
}

/// The triangles of a primitive.
pub(super) struct Part<'a> {
    pub primitive: Primitive<'a>,
    mesh: usize,
    vertices: usize,
    corners: usize,
    /// Index into [`Shape::positions`].
    pub positions: usize,
    /// Index into [`Shape::normals`].
    pub normals: Option<usize>,
}

impl<'a> Shape<'a> {
    pub fn count(mesh: &Mesh<'a>) -> Result<Self, Fault> {
        let mut shape = Self::default();
        for primitive in mesh.primitives() {
            let fault = |problem| fault(mesh.index(), &primitive, problem);
            let is_surface = !matches!(primitive.mode(), Mode::Points | Mode::Lines | Mode::LineLoop | Mode::LineStrip);
            let Some(positions) = primitive.get(&Semantic::Positions).filter(|_| is_surface) else {
                shape.left_out += 1;
                continue;
            };
            let vertices = positions.count();
            let attribute = |semantic: Semantic| match primitive.get(&semantic) {
                Some(accessor) if accessor.count() != vertices => {
                    let (name, count) = (semantic.to_string(), accessor.count());
                    Err(fault(format!("its {name} has {count} elements for {vertices} vertices")))
                }
                accessor => Ok(accessor.map(|accessor| accessor.index())),
            };
            let mut influences = Vec::new();
            for set in 0.. {
                match (attribute(Semantic::Joints(set))?, attribute(Semantic::Weights(set))?) {
                    (Some(joints), Some(weights)) => influences.push([joints, weights]),
                    _ => break,
                }
            }
            let normals = attribute(Semantic::Normals)?;
            let corners = primitive.indices().map_or(vertices, |indices| indices.count());
            if primitive.mode() == Mode::Triangles && corners % 3 != 0 {
                return Err(fault(format!("its {corners} corners do not make whole triangles")));
            }
            let whole = |vectors| Attribute { vectors, influences: influences.clone(), count: vertices };
            let positions = shape.positions.insert_full(whole(positions.index())).0;
            let normals = normals.map(|normals| shape.normals.insert_full(whole(normals)).0);
            shape.morphed += usize::from(primitive.morph_targets().len() > 0);
            shape.parts.push(Part { primitive, mesh: mesh.index(), vertices, corners, positions, normals });
        }
        shape.sizes = shape.sizes();
        Ok(shape)
    }

    fn sizes(&self) -> [usize; 4] {
        let sum = |numbers: &mut dyn Iterator<Item = usize>| numbers.fold(0, usize::saturating_add);
        // A part takes time even if it has no triangles.
        let influences =
            |attribute: &Attribute| attribute.influences.len().saturating_mul(attribute.count.saturating_add(1));
        let others = self.positions.iter().map(influences).chain([self.parts.len()]);
        [
            sum(&mut self.positions.iter().map(|positions| positions.count)),
            sum(&mut self.normals.iter().map(|normals| normals.count)),
            sum(&mut self.parts.iter().map(|part| match part.primitive.mode() {
                Mode::Triangles => part.corners / 3,
                _ => part.corners.saturating_sub(2),
            })),
            sum(&mut { others }),
        ]
    }
}

impl<'a> Part<'a> {
    /// The vertices of its triangles.
    pub fn triangles(&self, accessors: Accessors<'a>) -> Result<Vec<[u32; 3]>, Fault> {
        let corners: Vec<u32> = match self.primitive.indices() {
            Some(indices) => accessors.indices(indices)?.collect(),
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
