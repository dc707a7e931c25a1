//! The rays that leave a camera or a surface, as the course's renderer casts them.

use glam::{Vec2, Vec3};

use super::{Light, Scene, Surface};
use crate::geometry::{PrimId, Ray};

impl Scene {
    /// The rays through the point `offset` of the pixels `range`, counted row by row from the top left, on an image of
    /// `size`. `offset` is that of [`View::ray`](super::View::ray).
    pub fn primary_rays(&self, size: [u32; 2], offset: Vec2, range: std::ops::Range<u32>) -> Vec<Ray> {
        let view = self.camera.view(size);
        let ray = |pixel| view.ray(pixel % size[0], pixel / size[0], offset);
        range.map(ray).map(|ray| self.offset.leave_free(ray.origin, ray.direction)).collect()
    }

    /// The any-hit ray that asks whether `light` is hidden from the surface of `prim`.
    ///
    /// It is cast whether or not the light lies behind the surface. It ends at the distance of the light from the surface
    /// point, although it may start off the surface (see [`Scene::shadow_terminator_fix`]) and is moved by [`Scene::offset`]:
    /// an occluder so little beyond the light counts, as in the course.
    pub fn shadow_ray(&self, prim: PrimId, surface: &Surface, light: &Light) -> Ray {
        let mut start = surface.start();
        if surface.smooth && self.shadow_terminator_fix {
            start.point += surface.shading_normal * libm::pow(self.area(prim).into(), 0.05) as f32;
        }
        let distance = (light.position - surface.point).length();
        self.offset.leave(&start, light.position - start.point).until(distance)
    }

    /// `ray` reflected where it meets `surface`, about the shading normal.
    pub fn mirror_ray(&self, ray: &Ray, surface: &Surface) -> Ray {
        self.offset.leave(&surface.start(), reflect(ray.direction, surface.shading_normal))
    }
}

/// `direction` mirrored at the plane with the unit normal `normal`; either side.
fn reflect(direction: Vec3, normal: Vec3) -> Vec3 {
    direction - normal * (2.0 * direction.dot(normal))
}
