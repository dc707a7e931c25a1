//! Origins and directions of mirror rays.

use super::{Scene, Surface};
use crate::geometry::Ray;

impl Scene {
    /// `ray` reflected at `surface`, about the shading normal. It starts on the surface, offset by [`Scene::offset`].
    pub fn mirror_ray(&self, ray: &Ray, surface: &Surface) -> Ray {
        let (direction, normal) = (ray.direction, surface.shading_normal);
        self.offset.leave(&surface.point, direction - normal * (2.0 * direction.dot(normal)))
    }
}
