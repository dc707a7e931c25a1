//! Rays that start at primary hits.

use glam::Vec3;

use super::primary;
use super::source::Source;
use crate::accel::DynAccel;
use crate::geometry::{Hit, Ray};
use crate::scene::{Scene, Surface};

/// Number of rays per chunk. The hits do not depend on the chunk size.
const CHUNK: usize = 4096;

pub struct SurfaceHit {
    /// The index of the ray among the traced rays, including misses.
    pub number: usize,
    pub ray: Ray,
    pub hit: Hit,
    pub surface: Surface,
}

/// The hits of `rays` in the order of the rays, without misses.
pub fn surface_hits(scene: &Scene, rays: &[Ray], accel: &dyn DynAccel) -> Vec<SurfaceHit> {
    let hits = rays.iter().zip(accel.closest_by_chunks(rays, CHUNK)).enumerate();
    hits.filter_map(|(number, (&ray, hit))| {
        hit.map(|hit| SurfaceHit { number, ray, hit, surface: scene.surface(&ray, hit) })
    })
    .collect()
}

fn primary_hits(source: &mut Source) -> Vec<SurfaceHit> {
    surface_hits(source.scene, &primary::centres(source), source.accel)
}

pub fn shadow(source: &mut Source) -> Vec<Ray> {
    let (hits, scene) = (primary_hits(source), source.scene);
    let ray = |h: &SurfaceHit, light| scene.shadow_ray(h.hit.prim, &h.surface, light);
    scene.lights.iter().flat_map(|light| hits.iter().map(move |hit| ray(hit, light))).collect()
}

pub fn mirror(source: &mut Source) -> Vec<Ray> {
    primary_hits(source).iter().map(|hit| source.scene.mirror_ray(&hit.ray, &hit.surface)).collect()
}

/// The rays are cosine-distributed about the shading normal, on the side of the incoming ray.
pub fn diffuse(source: &mut Source) -> Vec<Ray> {
    let hits = primary_hits(source);
    let mut direction = |ray: &Ray, normal: Vec3| loop {
        let normal = if normal.dot(ray.direction) > 0.0 { -normal } else { normal }.as_dvec3();
        // The normal plus a uniform point on the unit sphere is cosine-distributed about the normal.
        let sum = normal + source.sampler.direction();
        if sum.length_squared() > 1e-12 {
            break sum.normalize().as_vec3();
        }
    };
    let leave =
        |h: &SurfaceHit| source.scene.offset.leave(&h.surface.point, direction(&h.ray, h.surface.shading_normal));
    hits.iter().map(leave).collect()
}

pub fn ambient(source: &mut Source) -> Vec<Ray> {
    let reach = 0.1 * source.scene.mesh.bounds().extent().as_dvec3().length();
    diffuse(source).into_iter().map(|ray| ray.until(reach as f32)).collect()
}
