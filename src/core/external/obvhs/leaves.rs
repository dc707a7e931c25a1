use std::sync::Arc;

use glam::Vec3A;
use obvhs::ray::{Ray as PreparedRay, RayHit};
use obvhs::triangle::Triangle;
use rayon::prelude::*;

use super::LeafTest;
use crate::accel::Footprint;
use crate::geometry::{Hit, Mesh, Ray};
use crate::traversal::pages;

/// Triangles in leaf order, prepared for the triangle test `T`.
pub(super) struct Leaves<T: LeafTest> {
    pub triangles: Vec<T::Triangle>,
    /// `triangles[i]` is triangle `ids[i]` of the mesh.
    pub ids: Vec<u32>,
}

/// The triangles with an area, in the format of obvhs. The second vector contains the index of each triangle in the
/// mesh.
pub(super) fn input(mesh: &Mesh) -> (Vec<Triangle>, Vec<u32>) {
    let ids: Vec<u32> = mesh.solid().collect();
    let triangle = |&id: &u32| {
        let [v0, v1, v2] = mesh.corners(id).map(Vec3A::from);
        Triangle { v0, v1, v2 }
    };
    (ids.par_iter().map(triangle).collect(), ids)
}

impl<T: LeafTest> Leaves<T> {
    pub fn new(mesh: &Arc<Mesh>, solid: &[u32], order: &[u32]) -> Self {
        let mut ids = pages::with_capacity(order.len());
        ids.par_extend(order.par_iter().map(|&i| solid[i as usize]));
        let mut triangles = pages::with_capacity(order.len());
        triangles.par_extend(ids.par_iter().map(|&id| T::triangle(mesh.corners(id))));
        Self { triangles, ids }
    }

    pub fn len(&self) -> usize {
        self.triangles.len()
    }

    /// `None` if the ray is invalid or the tree has no triangles.
    #[inline(always)]
    pub fn start(&self, ray: &Ray) -> Option<(PreparedRay, T::Ray)> {
        let (t_min, t_max) = ray.interval();
        (ray.is_valid() && !self.ids.is_empty()).then(|| {
            let prepared = PreparedRay::new(ray.origin.into(), ray.direction.into(), t_min, T::end(t_max));
            (prepared, T::prepare(ray))
        })
    }

    /// Returns the closure `test` for [`Tree::walk`](super::Tree::walk).
    ///
    /// # Safety
    /// The closure's argument `index` must be below [`Leaves::len`].
    #[inline(always)]
    pub unsafe fn test(&self, prepared: T::Ray) -> impl Fn(&PreparedRay, usize) -> f32 {
        move |ray, index| {
            debug_assert!(index < self.triangles.len());
            // SAFETY: by the contract of `Leaves::test`, `index` is below `len`.
            T::test(unsafe { self.triangles.get_unchecked(index) }, ray, &prepared)
        }
    }

    pub fn footprint(&self) -> Footprint {
        let (triangles, references) = (size_of_val(&self.triangles[..]), size_of_val(&self.ids[..]));
        Footprint { triangles, references, ..Footprint::default() }
    }

    #[inline(always)]
    pub fn hit(&self, found: RayHit) -> Hit {
        Hit::new(found.t, self.ids[found.primitive_id as usize])
    }
}
