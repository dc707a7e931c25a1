//! A scene, ready to trace.

use std::sync::Arc;

use glam::Vec3;

use super::offset::{Offset, Start, barycentrics};
use super::{Camera, CornerNormals, Light, Material};
use crate::geometry::{Hit, Mesh, PrimId, Ray};

/// Everything in world space: what structures are built over, what is seen of it and from where.
///
/// Each object's vertices follow those of the one before, in the order of the scene file; so do its triangles.
#[derive(Clone, Debug)]
pub struct Scene {
    pub name: String,
    pub mesh: Arc<Mesh>,
    /// None when every triangle is flat.
    pub normals: Option<CornerNormals>,
    pub materials: Vec<Material>,
    /// One number into `materials` a triangle.
    pub material_of: Vec<u32>,
    pub lights: Vec<Light>,
    pub camera: Camera,
    /// Colour of a ray that hits nothing.
    pub background: Vec3,
    /// Mirror rays are followed up to this level; the primary ray is level 0. Default 8.
    pub recursion_limit: u32,
    /// Whether shadow rays of smooth triangles start off the surface, at `point + normal * area^0.05`, as the course does
    /// against dark facets near the shadow boundary. Default true.
    pub shadow_terminator_fix: bool,
    /// How rays leave surfaces: error-bounded, but in a scene that says otherwise.
    pub offset: Offset,
    /// Width and height of the image that the scene asks for.
    pub size: [u32; 2],
    /// Meshes that stand in for a real one which is not there.
    pub stand_ins: Vec<String>,
    /// What a reader of results should know of the scene, one sentence each.
    pub notes: Vec<String>,
}

/// What shading needs to know about a hit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Surface {
    /// From barycentrics, see [`Start::on_triangle`]; in a scene with the course's offset `origin + t * direction`, as there.
    pub point: Vec3,
    /// See [`Start::error`].
    pub error: Vec3,
    /// Unit normal of the triangle, by the order of its corners.
    pub geometric_normal: Vec3,
    /// Unit normal interpolated between the corners; the geometric normal on a flat triangle.
    pub shading_normal: Vec3,
    /// Whether the corner normals differ.
    pub smooth: bool,
}

impl Surface {
    /// Where rays leave from.
    pub fn start(&self) -> Start {
        Start { point: self.point, error: self.error, normal: self.geometric_normal }
    }
}

impl Scene {
    /// The material of a primitive.
    #[inline]
    pub fn material(&self, prim: PrimId) -> &Material {
        &self.materials[self.material_of[prim.index() as usize] as usize]
    }

    /// Unit normal of a primitive by the order of its corners, `(b - a) x (c - a)`; zero on a degenerate one.
    pub fn geometric_normal(&self, prim: PrimId) -> Vec3 {
        let [a, b, c] = self.mesh.corners(prim.index()).map(Vec3::as_dvec3);
        (b - a).cross(c - a).normalize_or_zero().as_vec3()
    }

    /// Area of a primitive.
    pub fn area(&self, prim: PrimId) -> f32 {
        let [a, b, c] = self.mesh.corners(prim.index()).map(Vec3::as_dvec3);
        ((b - a).cross(c - a).length() * 0.5) as f32
    }

    /// Point and normals where `ray` hits, computed in `f64` from the ray and the corners.
    pub fn surface(&self, ray: &Ray, hit: Hit) -> Surface {
        let corners = self.mesh.corners(hit.prim.index());
        let weights = barycentrics(ray, corners);
        let start = Start::on_triangle(corners, weights);
        let normals = self.normals.as_ref().and_then(|n| n.corners(hit.prim.index()));
        let shading_normal = normals.map_or(start.normal, |normals| {
            let [n0, n1, n2] = normals.map(Vec3::as_dvec3);
            let mixed = n0 * weights.x + n1 * weights.y + n2 * weights.z;
            mixed.try_normalize().map_or(start.normal, |n| n.as_vec3())
        });
        let smooth = normals.is_some_and(|[n0, n1, n2]| n0 != n1 || n1 != n2);
        let point = if matches!(self.offset, Offset::Direction(_)) { ray.at(hit.t) } else { start.point };
        Surface { point, error: start.error, geometric_normal: start.normal, shading_normal, smooth }
    }

    /// Whether any triangle casts mirror rays.
    pub fn has_mirrors(&self) -> bool {
        let mirrors: Vec<bool> = self.materials.iter().map(|m| m.mirror > 0.0).collect();
        self.recursion_limit > 0 && self.material_of.iter().any(|&m| mirrors[m as usize])
    }
}
