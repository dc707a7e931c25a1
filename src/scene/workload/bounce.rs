//! Rays that start where primary rays end.

use glam::Vec3;
use rayon::prelude::*;

use super::super::{Scene, Surface};
use super::sampler::Sampler;
use crate::accel::DynAccel;
use crate::geometry::{Hit, Ray};

/// Rays that a thread hands over at once; the hits do not depend on it.
const CHUNK: usize = 4096;

/// A ray that has hit something.
pub struct Landed {
    /// Its number in the batch.
    pub number: usize,
    pub ray: Ray,
    pub hit: Hit,
    pub surface: Surface,
}

/// The rays of `rays` that hit, in order, with what they hit.
pub fn land(scene: &Scene, rays: &[Ray], accel: &dyn DynAccel) -> Vec<Landed> {
    let mut hits = vec![None; rays.len()];
    rays.par_chunks(CHUNK).zip(hits.par_chunks_mut(CHUNK)).for_each(|(rays, hits)| accel.closest_hits(rays, hits));
    let hits = rays.iter().zip(hits).enumerate();
    hits.filter_map(|(number, (&ray, hit))| {
        hit.map(|hit| Landed { number, ray, hit, surface: scene.surface(&ray, hit) })
    })
    .collect()
}

/// One ray a light from where `landed` is.
pub fn to_lights<'a>(scene: &'a Scene, landed: &'a Landed) -> impl Iterator<Item = Ray> + 'a {
    scene.lights.iter().map(|light| scene.shadow_ray(landed.hit.prim, &landed.surface, light))
}

pub fn shadow(scene: &Scene, rays: &[Ray], accel: &dyn DynAccel) -> Vec<Ray> {
    let landed = land(scene, rays, accel);
    let shadow = |l: &Landed, light| scene.shadow_ray(l.hit.prim, &l.surface, light);
    scene.lights.iter().flat_map(|light| landed.iter().map(move |l| shadow(l, light))).collect()
}

pub fn mirror(scene: &Scene, rays: &[Ray], accel: &dyn DynAccel) -> Vec<Ray> {
    land(scene, rays, accel).iter().map(|landed| scene.mirror_ray(&landed.ray, &landed.surface)).collect()
}

pub fn diffuse(scene: &Scene, rays: &[Ray], accel: &dyn DynAccel, seed: u64) -> Vec<Ray> {
    hemisphere(scene, rays, accel, Sampler::new("diffuse", seed))
}

pub fn ambient(scene: &Scene, rays: &[Ray], accel: &dyn DynAccel, seed: u64) -> Vec<Ray> {
    let reach = 0.1 * scene.mesh.bounds().extent().as_dvec3().length();
    let rays = hemisphere(scene, rays, accel, Sampler::new("ambient", seed));
    rays.into_iter().map(|ray| ray.until(reach as f32)).collect()
}

/// One ray a hit, cosine-distributed about the shading normal on the side that the ray came from.
fn hemisphere(scene: &Scene, rays: &[Ray], accel: &dyn DynAccel, mut sampler: Sampler) -> Vec<Ray> {
    let direction = |ray: &Ray, normal: Vec3, sampler: &mut Sampler| loop {
        let normal = if normal.dot(ray.direction) > 0.0 { -normal } else { normal }.as_dvec3();
        // A unit vector plus a point of the unit sphere is distributed by the cosine.
        let sum = normal + sampler.direction();
        if sum.length_squared() > 1e-12 {
            break sum.normalize().as_vec3();
        }
    };
    land(scene, rays, accel)
        .iter()
        .map(|l| scene.offset.leave(&l.surface.start(), direction(&l.ray, l.surface.shading_normal, &mut sampler)))
        .collect()
}
