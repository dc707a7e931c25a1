use crate::geometry::{Aabb, Mesh};
use crate::structures::extent::Extent;
use crate::structures::kd::clip::cut_bounds;

/// A triangle and the box of the part of it that a node answers for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::structures) struct Reference {
    pub id: u32,
    pub bounds: Aabb,
}

impl Reference {
    #[inline(always)]
    pub fn extent(&self) -> Extent {
        self.bounds.into()
    }

    /// The centre of the box on an axis.
    #[inline(always)]
    pub fn centre(&self, axis: usize) -> f32 {
        self.bounds.min[axis] * 0.5 + self.bounds.max[axis] * 0.5
    }

    /// The parts below and above a plane that meets the inside of the box.
    pub fn cut(&self, mesh: &Mesh, axis: usize, plane: f32) -> (Self, Self) {
        let (below, above) = cut_bounds(mesh.corners(self.id), &self.bounds, axis, plane);
        (Self { bounds: below, ..*self }, Self { bounds: above, ..*self })
    }
}

/// The box of all references.
pub(super) fn bounds<'a>(references: impl IntoIterator<Item = &'a Reference>) -> Extent {
    references.into_iter().fold(Extent::EMPTY, |all, r| all.union(r.extent()))
}
