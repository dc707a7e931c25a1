//! A scene, ready to trace.

use std::fmt::Write;
use std::sync::Arc;

use glam::{DVec3, Vec3};
use sha2::{Digest, Sha256};

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
    /// Every ray origin is first moved so far along the unit direction, see [`Scene::launch`].
    pub ray_offset: f32,
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
    /// `origin + t * direction`, rounded.
    pub point: Vec3,
    /// Unit normal of the triangle, by the order of its corners.
    pub geometric_normal: Vec3,
    /// Unit normal interpolated between the corners; the geometric normal on a flat triangle.
    pub shading_normal: Vec3,
    /// Whether the corner normals differ.
    pub smooth: bool,
}

impl Scene {
    /// A ray as the renderer casts it: `direction` brought to unit length, the origin moved [`Scene::ray_offset`] along it.
    ///
    /// The course's guard against hitting the surface a ray starts on. Distances along the ray count from the moved origin.
    pub fn launch(&self, origin: Vec3, direction: Vec3) -> Ray {
        let direction = direction.normalize();
        Ray::new(origin + direction * self.ray_offset, direction)
    }

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
        let geometric_normal = self.geometric_normal(hit.prim);
        let corners = self.normals.as_ref().and_then(|n| n.corners(hit.prim.index()));
        let shading_normal = corners.map_or(geometric_normal, |normals| {
            let weights = barycentrics(ray, self.mesh.corners(hit.prim.index()));
            let [n0, n1, n2] = normals.map(Vec3::as_dvec3);
            let mixed = n0 * weights.x + n1 * weights.y + n2 * weights.z;
            mixed.try_normalize().map_or(geometric_normal, |n| n.as_vec3())
        });
        let smooth = corners.is_some_and(|[n0, n1, n2]| n0 != n1 || n1 != n2);
        Surface { point: ray.at(hit.t), geometric_normal, shading_normal, smooth }
    }

    /// Whether any triangle casts mirror rays.
    pub fn has_mirrors(&self) -> bool {
        let mirrors: Vec<bool> = self.materials.iter().map(|m| m.mirror > 0.0).collect();
        self.recursion_limit > 0 && self.material_of.iter().any(|&m| mirrors[m as usize])
    }

    /// SHA-256, in hexadecimal, of what rays can meet and where primary rays start: vertices, triangles and camera.
    pub fn hash(&self) -> String {
        let mut hasher = Sha256::new();
        hasher.update((self.mesh.positions().len() as u64).to_le_bytes());
        for position in self.mesh.positions() {
            update(&mut hasher, *position);
        }
        for corner in self.mesh.triangles().as_flattened() {
            hasher.update(corner.to_le_bytes());
        }
        for vector in [self.camera.eye(), self.camera.target(), self.camera.up()] {
            update(&mut hasher, vector);
        }
        hasher.update(self.camera.vertical_fov().to_bits().to_le_bytes());
        hasher.finalize().iter().fold(String::with_capacity(64), |mut text, byte| {
            write!(text, "{byte:02x}").expect("a string takes every write");
            text
        })
    }
}

fn update(hasher: &mut Sha256, vector: Vec3) {
    for component in vector.to_array() {
        hasher.update(component.to_bits().to_le_bytes());
    }
}

/// Weights of the corners where the ray meets their plane, by Cramer's rule; equal ones when it runs in the plane.
fn barycentrics(ray: &Ray, corners: [Vec3; 3]) -> DVec3 {
    let [a, b, c] = corners.map(Vec3::as_dvec3);
    let (origin, direction) = (ray.origin.as_dvec3(), ray.direction.as_dvec3());
    let (ab, ac, from_a) = (b - a, c - a, origin - a);
    let p = direction.cross(ac);
    let determinant = ab.dot(p);
    if determinant == 0.0 {
        return DVec3::splat(1.0 / 3.0);
    }
    let v = from_a.dot(p) / determinant;
    let w = direction.dot(from_a.cross(ab)) / determinant;
    DVec3::new(1.0 - v - w, v, w)
}
