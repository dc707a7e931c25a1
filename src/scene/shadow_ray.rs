//! Origins and ends of shadow rays.

use super::{Light, Scene, Surface};
use crate::geometry::{PrimId, Ray};

impl Scene {
    /// The any-hit ray that tests whether `light` is hidden from the surface of `prim`.
    ///
    /// It starts on the surface, or off it by [`Scene::shadow_terminator_fix`], with the offset [`Scene::offset`]. Its
    /// length is the distance of the light from the surface point: as in the course, an occluder slightly beyond the
    /// light counts. Lights behind the surface have shadow rays too.
    pub fn shadow_ray(&self, prim: PrimId, surface: &Surface, light: &Light) -> Ray {
        let mut start = surface.point;
        if surface.smooth && self.shadow_terminator_fix {
            start.position += surface.shading_normal * libm::pow(self.area(prim).into(), 0.05) as f32;
        }
        let distance = (light.position - surface.point.position).length();
        self.offset.leave(&start, light.position - start.position).until(distance)
    }
}
