use glam::Vec3;

use crate::geometry::{Aabb, Mesh};
use crate::structures::leaf::Nearest;
use crate::triangle::TriangleTest;

/// The triangles with an area, in the order of the mesh, ready for the test `T`: what a peer that knows boxes alone leaves
/// to its caller.
pub(super) struct Leaves<T: TriangleTest> {
    triangles: Vec<T::Block<1>>,
    /// The triangle of the mesh for each of them.
    ids: Vec<u32>,
}

impl<T: TriangleTest> Leaves<T> {
    pub fn new(mesh: &Mesh) -> Self {
        let ids: Vec<u32> = mesh.solid().collect();
        let triangles = ids.iter().map(|&id| T::block(&[mesh.corners(id)])).collect();
        Self { triangles, ids }
    }

    #[cfg(feature = "peer-parry")]
    pub fn len(&self) -> usize {
        self.ids.len()
    }

    /// The boxes of the triangles, in order.
    pub fn boxes(&self, mesh: &Mesh) -> impl Iterator<Item = [Vec3; 2]> {
        self.ids.iter().map(|&id| {
            let Aabb { min, max } = mesh.triangle_bounds(id);
            [min, max]
        })
    }

    /// Tests triangle `index`, and keeps its hit if it is the nearest so far.
    #[inline(always)]
    pub fn test(&self, index: usize, ray: &T::Ray, t_min: f32, nearest: &mut Nearest<T::Depth>) {
        if let Some(depth) = T::hit(ray, &self.triangles[index], t_min, nearest.t) {
            nearest.offer(depth, self.ids[index]);
        }
    }

    /// Bytes of the triangles and of their numbers.
    pub fn bytes(&self) -> (usize, usize) {
        (size_of_val(&self.triangles[..]), size_of_val(&self.ids[..]))
    }
}
