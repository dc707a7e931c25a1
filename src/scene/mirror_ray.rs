//! Where mirror rays start and where they go.

use super::{Scene, Surface};
use crate::geometry::Ray;

impl Scene {
    /// `ray` reflected where it meets `surface`, about the shading normal. It starts on the surface, moved by
    /// [`Scene::offset`].
    pub fn mirror_ray(&self, ray: &Ray, surface: &Surface) -> Ray {
        let (direction, normal) = (ray.direction, surface.shading_normal);
        self.offset.leave(&surface.point, direction - normal * (2.0 * direction.dot(normal)))
    }
}
