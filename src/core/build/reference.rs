use glam::{Vec3, Vec3A, Vec4};

use super::clip::cut_bounds;
use super::extent::Extent;
use crate::geometry::{Aabb, Mesh};

/// Several threads process a node with at least this many references.
pub(crate) const PARALLEL: usize = 4096;

/// Number of references per parallel task.
pub(crate) const CHUNK: usize = 2048;

/// A triangle number and the box of the triangle's part in a node. The fourth lane of `low` has the bits of the number.
/// Each corner of the box is one SIMD load.
#[derive(Clone, Copy, Debug)]
#[repr(align(32))]
pub(crate) struct Reference {
    low: [f32; 4],
    high: [f32; 4],
}

impl Reference {
    pub fn new(id: u32, Aabb { min, max }: Aabb) -> Self {
        // Triangle numbers are below 2^30, so the float is not a NaN. A copy might change the bits of a NaN.
        Self { low: min.extend(f32::from_bits(id)).to_array(), high: max.extend(0.0).to_array() }
    }

    pub fn whole(mesh: &Mesh, id: u32) -> Self {
        Self::new(id, mesh.triangle_bounds(id))
    }

    #[inline(always)]
    pub fn id(&self) -> u32 {
        self.low[3].to_bits()
    }

    #[inline(always)]
    pub fn min(&self, axis: usize) -> f32 {
        self.low[axis & 3]
    }

    #[inline(always)]
    pub fn max(&self, axis: usize) -> f32 {
        self.high[axis & 3]
    }

    #[inline(always)]
    pub fn extent(&self) -> Extent {
        let corner = |corner| Vec3A::from_vec4(Vec4::from_array(corner));
        Extent { min: corner(self.low), max: corner(self.high) }
    }

    pub fn bounds(&self) -> Aabb {
        let corner = |[x, y, z, _]: [f32; 4]| Vec3::new(x, y, z);
        Aabb { min: corner(self.low), max: corner(self.high) }
    }

    #[inline(always)]
    pub fn centre(&self, axis: usize) -> f32 {
        self.min(axis) * 0.5 + self.max(axis) * 0.5
    }

    /// The parts below and above a plane. The plane must cut the interior of the box.
    pub fn cut(&self, mesh: &Mesh, axis: usize, plane: f32) -> (Self, Self) {
        let (below, above) = cut_bounds(mesh.corners(self.id()), &self.bounds(), axis, plane);
        (Self::new(self.id(), below), Self::new(self.id(), above))
    }
}

pub(crate) fn bounds<'a>(references: impl IntoIterator<Item = &'a Reference>) -> Extent {
    references.into_iter().fold(Extent::EMPTY, |all, r| all.union(r.extent()))
}
