//! A mesh of a glTF file, in its own space.

use glam::Vec3;
use gltf::mesh::{Mode, Semantic};
use gltf::{Accessor, Mesh, Primitive};

use super::accessors::Accessors;
use crate::scene::load::error::Fault;

/// The material number of a primitive that names no material.
pub(super) const NO_MATERIAL: u32 = u32::MAX;

/// Triangles and what they share: primitives often use one accessor together.
pub(super) struct Shape {
    pub positions: Vec<Vec<Vec3>>,
    pub normals: Vec<Vec<Vec3>>,
    pub parts: Vec<Part>,
}

pub(super) struct Part {
    /// Number of its list of positions.
    pub positions: usize,
    /// Number of its list of normals, which is as long as that of its positions.
    pub normals: Option<usize>,
    pub triangles: Vec<[u32; 3]>,
    pub material: u32,
}

impl Shape {
    pub fn read<'a>(mesh: &Mesh<'a>, accessors: &Accessors<'a>) -> Result<Self, Fault> {
        let mut positions = Lists::default();
        let mut normals = Lists::default();
        let mut parts = Vec::new();
        for primitive in mesh.primitives() {
            let fault = |problem: String| {
                Fault::part(format!("mesh {}, primitive {}", mesh.index(), primitive.index()), problem)
            };
            if !matches!(primitive.mode(), Mode::Triangles | Mode::TriangleStrip | Mode::TriangleFan) {
                continue;
            }
            let Some(accessor) = primitive.get(&Semantic::Positions) else { continue };
            let own_positions = positions.read(&accessor, accessors)?;
            let count = positions.lists[own_positions].len();
            let own_normals = match primitive.get(&Semantic::Normals) {
                None => None,
                Some(accessor) => Some(normals.read(&accessor, accessors)?),
            };
            if let Some(found) = own_normals.map(|n| normals.lists[n].len()).filter(|&found| found != count) {
                return Err(fault(format!("it has {found} normals for {count} vertices")));
            }
            parts.push(Part {
                positions: own_positions,
                normals: own_normals,
                triangles: triangles(&primitive, count, accessors, fault)?,
                material: primitive.material().index().map_or(NO_MATERIAL, |m| m as u32),
            });
        }
        Ok(Self { positions: positions.lists, normals: normals.lists, parts })
    }

    /// Numbers of vertices, normals and triangles.
    pub fn sizes(&self) -> [usize; 3] {
        let total = |lists: &[Vec<Vec3>]| lists.iter().map(Vec::len).sum();
        let triangles = self.parts.iter().map(|part| part.triangles.len()).sum();
        [total(&self.positions), total(&self.normals), triangles]
    }
}

/// Vectors by the accessors that they came from.
#[derive(Default)]
struct Lists {
    accessors: Vec<usize>,
    lists: Vec<Vec<Vec3>>,
}

impl Lists {
    fn read<'a>(&mut self, accessor: &Accessor<'a>, accessors: &Accessors<'a>) -> Result<usize, Fault> {
        if let Some(known) = self.accessors.iter().position(|&a| a == accessor.index()) {
            return Ok(known);
        }
        self.lists.push(accessors.vectors(accessor)?);
        self.accessors.push(accessor.index());
        Ok(self.lists.len() - 1)
    }
}

fn triangles<'a>(
    primitive: &Primitive<'a>,
    vertices: usize,
    accessors: &Accessors<'a>,
    fault: impl Fn(String) -> Fault,
) -> Result<Vec<[u32; 3]>, Fault> {
    let corners = match primitive.indices() {
        Some(accessor) => accessors.indices(&accessor)?,
        None => (0..vertices as u32).collect(),
    };
    if let Some((number, index)) = corners.iter().enumerate().find(|&(_, &index)| index as usize >= vertices) {
        return Err(fault(format!("its index {number} names vertex {index}, but there are only {vertices}")));
    }
    Ok(match primitive.mode() {
        Mode::TriangleStrip => {
            let turned = |(i, w): (usize, &[u32])| if i % 2 == 0 { [w[0], w[1], w[2]] } else { [w[0], w[2], w[1]] };
            corners.windows(3).enumerate().map(turned).collect()
        }
        Mode::TriangleFan => corners.windows(2).skip(1).map(|pair| [corners[0], pair[0], pair[1]]).collect(),
        _ => {
            let (triangles, rest) = corners.as_chunks();
            if !rest.is_empty() {
                return Err(fault(format!("its {} corners do not make whole triangles", corners.len())));
            }
            triangles.to_vec()
        }
    })
}
