//! A mesh of a glTF file, in its own space.

use glam::DVec3;
use gltf::mesh::{Mode, Semantic};
use gltf::{Accessor, Mesh};

use super::accessors::Accessors;
use crate::scene::load::error::Fault;

/// The material number of a primitive that names no material.
pub(super) const NO_MATERIAL: u32 = u32::MAX;

/// Triangles and what they share, checked and not yet read: primitives often use one accessor together.
#[derive(Default)]
pub(super) struct Shape<'a> {
    pub positions: Vec<Accessor<'a>>,
    pub normals: Vec<Accessor<'a>>,
    pub parts: Vec<Part<'a>>,
    /// The box of all positions.
    pub bounds: Option<[DVec3; 2]>,
    /// Primitives that are points or lines, or have no positions.
    pub left_out: usize,
    /// Primitives with morph targets.
    pub morphed: usize,
}

pub(super) struct Part<'a> {
    /// Number of its list of positions.
    pub positions: usize,
    /// Number of its list of normals, which is as long as that of its positions.
    pub normals: Option<usize>,
    /// Its corners, by the numbers of vertices; none where these are the vertices in their order.
    corners: Option<Accessor<'a>>,
    /// How many corners.
    count: usize,
    mode: Mode,
    pub material: u32,
}

impl<'a> Shape<'a> {
    pub fn check(mesh: &Mesh<'a>, accessors: &Accessors<'a>) -> Result<Self, Fault> {
        let mut shape = Self::default();
        for primitive in mesh.primitives() {
            let fault = |problem: String| {
                Fault::part(format!("mesh {}, primitive {}", mesh.index(), primitive.index()), problem)
            };
            let accessor = primitive.get(&Semantic::Positions);
            let accessor = accessor
                .filter(|_| matches!(primitive.mode(), Mode::Triangles | Mode::TriangleStrip | Mode::TriangleFan));
            let Some(accessor) = accessor else {
                shape.left_out += 1;
                continue;
            };
            let [min, max] = accessors.check_positions(&accessor)?;
            let [all_min, all_max] = shape.bounds.unwrap_or([min, max]);
            shape.bounds = Some([all_min.min(min), all_max.max(max)]);
            let vertices = accessor.count();
            let positions = number(&mut shape.positions, accessor);

            let normals = match primitive.get(&Semantic::Normals) {
                None => None,
                Some(accessor) if accessor.count() != vertices => {
                    let problem = format!("it has {} normals for {vertices} vertices", accessor.count());
                    return Err(fault(problem));
                }
                Some(accessor) => {
                    accessors.check_vectors(&accessor)?;
                    Some(number(&mut shape.normals, accessor))
                }
            };
            let corners = primitive.indices();
            if let Some(accessor) = &corners
                && let Some((number, index)) = accessors.check_indices(accessor)?
                && index as usize >= vertices
            {
                let problem = format!("its index {number} names vertex {index}, but there are only {vertices}");
                return Err(fault(problem));
            }
            let count = corners.as_ref().map_or(vertices, Accessor::count);
            if primitive.mode() == Mode::Triangles && count % 3 != 0 {
                return Err(fault(format!("its {count} corners do not make whole triangles")));
            }
            shape.morphed += usize::from(primitive.morph_targets().next().is_some());
            let material = primitive.material().index().map_or(NO_MATERIAL, |m| m as u32);
            shape.parts.push(Part { positions, normals, corners, count, mode: primitive.mode(), material });
        }
        Ok(shape)
    }

    /// Numbers of vertices, normals and triangles.
    pub fn sizes(&self) -> [usize; 3] {
        let total = |lists: &[Accessor]| lists.iter().map(Accessor::count).fold(0, usize::saturating_add);
        let triangles = self.parts.iter().map(Part::triangles).fold(0, usize::saturating_add);
        [total(&self.positions), total(&self.normals), triangles]
    }
}

/// The number of an accessor in a list, to which it is added if it is not there.
fn number<'a>(list: &mut Vec<Accessor<'a>>, accessor: Accessor<'a>) -> usize {
    list.iter().position(|a| a.index() == accessor.index()).unwrap_or_else(|| {
        list.push(accessor);
        list.len() - 1
    })
}

impl<'a> Part<'a> {
    fn triangles(&self) -> usize {
        if self.mode == Mode::Triangles { self.count / 3 } else { self.count.saturating_sub(2) }
    }

    /// Hands over all triangles by their vertices.
    pub fn for_each(&self, accessors: &Accessors<'a>, mut take: impl FnMut([u32; 3])) {
        let corners = match &self.corners {
            Some(accessor) => accessors.indices(accessor),
            None => Box::new(0..self.count as u32),
        };
        let [mut a, mut b] = [0; 2];
        for (i, c) in corners.enumerate() {
            let last = match self.mode {
                Mode::TriangleStrip if i % 2 == 1 => [a, c, b],
                _ => [a, b, c],
            };
            if i % 3 == 2 || i > 2 && self.mode != Mode::Triangles {
                take(last);
            }
            match self.mode {
                Mode::TriangleStrip => [a, b] = [b, c],
                Mode::TriangleFan if i == 0 => a = c,
                Mode::TriangleFan => b = c,
                _ if i % 3 == 0 => a = c,
                _ => b = c,
            }
        }
    }
}
