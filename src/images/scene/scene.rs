//! A scene, ready to trace.

use std::sync::Arc;

use glam::{Vec2, Vec3};

use super::offset::{Offset, SurfacePoint, barycentrics};
use super::{Camera, CornerNormals, Light, Material};
use crate::geometry::{Hit, Mesh, PrimId, Ray};

/// The mesh contains the triangles of the objects in the order of the scene file.
#[derive(Clone, Debug)]
pub struct Scene {
    pub name: String,
    pub mesh: Arc<Mesh>,
    pub normals: Option<CornerNormals>,
    pub materials: Vec<Material>,
    pub material_of: Vec<u32>,
    pub lights: Vec<Light>,
    pub camera: Camera,
    pub background: Vec3,
    /// The highest level of mirror rays. Primary rays have level 0.
    pub recursion_limit: u32,
    /// Whether the origins of shadow rays from smooth triangles move by `shading_normal * area^0.05`. The source report
    /// avoids dark facets near the shadow boundary in this way.
    pub shadow_terminator_fix: bool,
    pub offset: Offset,
    pub size: [u32; 2],
    /// Whether [`Scene::framed`] made the scene.
    pub is_framed: bool,
    /// Names of the generated meshes that replace missing meshes.
    pub stand_ins: Vec<String>,
    /// Notes for readers of results, one sentence each.
    pub notes: Vec<String>,
    /// Notes to print before the measurement.
    pub warnings: Vec<String>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Surface {
    /// The hit point, before [`Scene::offset`] moves it, from [`SurfacePoint::on_triangle`]. With
    /// [`Offset::Direction`], the position is `origin + t * direction`, and `error` is no bound for it.
    pub point: SurfacePoint,
    /// Interpolated unit normal. A triangle without corner normals has the geometric normal.
    pub shading_normal: Vec3,
    /// Whether the corner normals differ.
    pub smooth: bool,
}

impl Scene {
    /// Pixels are numbered row by row from the top left. `offset` is a position in the pixel, see
    /// [`View::ray`](super::View::ray).
    pub fn primary_rays(&self, size: [u32; 2], offset: Vec2, range: std::ops::Range<u32>) -> Vec<Ray> {
        let view = self.camera.view(size);
        let ray = |pixel| view.ray(pixel % size[0], pixel / size[0], offset);
        range.map(ray).map(|ray| self.offset.leave_free(ray.origin, ray.direction)).collect()
    }

    #[inline]
    pub fn material(&self, prim: PrimId) -> &Material {
        &self.materials[self.material_of[prim.index() as usize] as usize]
    }

    pub fn area(&self, prim: PrimId) -> f32 {
        let [a, b, c] = self.mesh.corners(prim.index()).map(Vec3::as_dvec3);
        ((b - a).cross(c - a).length() * 0.5) as f32
    }

    pub fn surface(&self, ray: &Ray, hit: Hit) -> Surface {
        let corners = self.mesh.corners(hit.prim.index());
        let weights = barycentrics(ray, corners);
        let mut point = SurfacePoint::on_triangle(corners, weights);
        let normals = self.normals.as_ref().and_then(|n| n.corners(hit.prim.index()));
        let shading_normal = normals.map_or(point.normal, |normals| {
            let [n0, n1, n2] = normals.map(Vec3::as_dvec3);
            let mixed = n0 * weights.x + n1 * weights.y + n2 * weights.z;
            mixed.try_normalize().map_or(point.normal, |n| n.as_vec3())
        });
        let smooth = normals.is_some_and(|[n0, n1, n2]| n0 != n1 || n1 != n2);
        if matches!(self.offset, Offset::Direction(_)) {
            point.position = ray.at(hit.t);
        }
        Surface { point, shading_normal, smooth }
    }

    /// `t_max` is the distance from `surface.point` to the light. The ray may hit an occluder slightly beyond the
    /// light, as in the source report. Lights behind the surface get shadow rays as well.
    pub fn shadow_ray(&self, prim: PrimId, surface: &Surface, light: &Light) -> Ray {
        let mut start = surface.point;
        if surface.smooth && self.shadow_terminator_fix {
            start.position += surface.shading_normal * libm::pow(self.area(prim).into(), 0.05) as f32;
        }
        let distance = (light.position - surface.point.position).length();
        self.offset.leave(&start, light.position - start.position).until(distance)
    }

    pub fn mirror_ray(&self, ray: &Ray, surface: &Surface) -> Ray {
        let (direction, normal) = (ray.direction, surface.shading_normal);
        self.offset.leave(&surface.point, direction - normal * (2.0 * direction.dot(normal)))
    }

    pub fn has_mirrors(&self) -> bool {
        let mirrors: Vec<bool> = self.materials.iter().map(|m| m.mirror > 0.0).collect();
        self.recursion_limit > 0 && self.material_of.iter().any(|&m| mirrors[m as usize])
    }
}
