use crate::accel::Footprint;
use crate::geometry::{Aabb, Mesh, Ray};
use crate::traversal::leaf::{Nearest, start};
use crate::triangle::TriangleTest;

/// The triangles with an area, prepared for the triangle test `T`.
pub(super) struct Leaves<T: TriangleTest> {
    triangles: Vec<T::Block<1>>,
    /// `triangles[i]` is triangle `ids[i]` of the mesh.
    pub ids: Vec<u32>,
}

pub(super) struct Start<T: TriangleTest> {
    pub original: Ray,
    pub ray: T::Ray,
    pub t_min: f32,
    /// A hit must lie at or before this `t`.
    last: f32,
}

impl<T: TriangleTest> Start<T> {
    /// `None` if the ray is invalid.
    #[inline(always)]
    pub fn new(ray: &Ray) -> Option<Self> {
        start::<T>(ray).map(|(t_min, nearest)| Self { original: *ray, ray: T::prepare(ray), t_min, last: nearest.t })
    }

    #[inline(always)]
    pub fn nearest<'a>(&self) -> Nearest<T::Depth<'a>> {
        Nearest::until(self.last)
    }
}

impl<T: TriangleTest> Leaves<T> {
    pub fn new(mesh: &Mesh) -> Self {
        let ids: Vec<u32> = mesh.solid().collect();
        let triangles = ids.iter().map(|&id| T::block(&[mesh.corners(id)])).collect();
        Self { triangles, ids }
    }

    /// The boxes of the triangles, in the order of `ids`.
    pub fn boxes(&self, mesh: &Mesh) -> impl Iterator<Item = Aabb> {
        self.ids.iter().map(|&id| mesh.triangle_bounds(id))
    }

    /// `index` is a position in `ids`.
    #[inline(always)]
    pub fn test<'a>(&'a self, index: usize, start: &Start<T>, nearest: &mut Nearest<T::Depth<'a>>) {
        if let Some(depth) = T::hit(&start.ray, &self.triangles[index], start.t_min, nearest.t) {
            nearest.offer(depth, self.ids[index], |one, other| T::order(&start.ray, one, other));
        }
    }

    pub fn footprint(&self) -> Footprint {
        let (triangles, references) = (size_of_val(&self.triangles[..]), size_of_val(&self.ids[..]));
        Footprint { triangles, references, ..Footprint::default() }
    }
}
