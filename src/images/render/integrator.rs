//! Renders Blinn-Phong materials, hard shadows and mirrors.

use glam::Vec3;
use rayon::prelude::*;

use crate::accel::DynAccel;
use crate::geometry::{Hit, Ray};
use crate::scene::{Light, Material, Scene, Surface};

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct RayCounts {
    /// One closest-hit ray per pixel.
    pub primary: u64,
    /// One closest-hit ray per hit on a mirror material, up to the recursion limit.
    pub mirror: u64,
    /// One any-hit ray per light for each hit of a primary or mirror ray.
    pub shadow: u64,
}

/// Primary rays per batch.
const CHUNK: usize = 4096;

/// The linear RGB colours of primary rays. `accel` must be built over the scene's mesh. The colours do not depend
/// on the batches or on the number of threads.
pub fn shade(scene: &Scene, accel: &dyn DynAccel, rays: &[Ray]) -> Vec<Vec3> {
    rays.par_chunks(CHUNK).flat_map_iter(|chunk| trace(scene, accel, chunk.to_vec()).0).collect()
}

pub fn count_rays(scene: &Scene, accel: &dyn DynAccel, rays: &[Ray]) -> RayCounts {
    let counts = rays.par_chunks(CHUNK).map(|chunk| trace(scene, accel, chunk.to_vec()).1);
    counts.reduce(RayCounts::default, |a, b| RayCounts {
        primary: a.primary + b.primary,
        mirror: a.mirror + b.mirror,
        shadow: a.shadow + b.shadow,
    })
}

#[derive(Default)]
struct MirrorLevel {
    /// The colour of each ray, before the colour of its mirror ray is added.
    colours: Vec<Vec3>,
    /// One pair per mirror ray: the index of the parent ray, and the weight of the mirror ray.
    mirrors: Vec<(usize, f32)>,
}

fn trace(scene: &Scene, accel: &dyn DynAccel, mut rays: Vec<Ray>) -> (Vec<Vec3>, RayCounts) {
    let mut counts = RayCounts { primary: rays.len() as u64, ..RayCounts::default() };

    let mut levels = vec![];
    while !rays.is_empty() {
        let follow = (levels.len() as u32) < scene.recursion_limit;
        let (level, mirrored) = shade_level(scene, accel, &rays, follow, &mut counts);
        counts.mirror += mirrored.len() as u64;
        levels.push(level);
        rays = mirrored;
    }

    // Add the colours from the last level to the first. `seen` contains the colours of the next level, limited by
    // `balance`.
    let mut seen: Vec<Vec3> = vec![];
    for mut level in levels.into_iter().rev() {
        for ((parent, weight), colour) in level.mirrors.into_iter().zip(seen) {
            level.colours[parent] += colour * weight;
        }
        level.colours.iter_mut().for_each(|colour| *colour = balance(*colour));
        seen = level.colours;
    }
    (seen, counts)
}

fn shade_level(
    scene: &Scene,
    accel: &dyn DynAccel,
    rays: &[Ray],
    follow: bool,
    counts: &mut RayCounts,
) -> (MirrorLevel, Vec<Ray>) {
    let hits = accel.closest(rays);
    let surfaces: Vec<(usize, Hit, Surface)> =
        hits.iter().enumerate().filter_map(|(i, hit)| hit.map(|hit| (i, hit, scene.surface(&rays[i], hit)))).collect();

    let shadow_rays: Vec<Ray> = surfaces
        .iter()
        .flat_map(|(_, hit, surface)| scene.lights.iter().map(|light| scene.shadow_ray(hit.prim, surface, light)))
        .collect();
    let hidden = accel.any(&shadow_rays);
    counts.shadow += shadow_rays.len() as u64;

    let mut level = MirrorLevel { colours: vec![scene.background; rays.len()], mirrors: vec![] };
    let mut mirrored = vec![];
    for (n, (i, hit, surface)) in surfaces.iter().enumerate() {
        let material = scene.material(hit.prim);
        let hidden = &hidden[n * scene.lights.len()..][..scene.lights.len()];
        let visible = scene.lights.iter().zip(hidden).filter(|(_, hidden)| !**hidden).map(|(light, _)| light);
        let lit: Vec3 = visible.map(|light| reflected(material, surface, light, scene.camera.eye())).sum();
        level.colours[*i] = material.ambient * material.diffuse + lit;
        if follow && material.mirror > 0.0 {
            level.mirrors.push((*i, material.mirror));
            mirrored.push(scene.mirror_ray(&rays[*i], surface));
        }
    }
    (level, mirrored)
}

/// The light that a surface reflects to the eye, by the models of Lambert and Blinn-Phong.
///
/// As in the renderer of the student's course, the view vector points to the eye, even if a mirror shows the surface.
fn reflected(material: &Material, surface: &Surface, light: &Light, eye: Vec3) -> Vec3 {
    let normal = surface.shading_normal;
    let to_light = light.position - surface.point.position;
    let distance = to_light.length();
    let to_light = to_light / distance;
    let facing = normal.dot(to_light);
    // If the light is at the surface point, `facing` is NaN.
    if facing.is_nan() || facing <= 0.0 {
        return Vec3::ZERO;
    }

    let half = (to_light + (eye - surface.point.position).normalize()).normalize();
    let along = normal.dot(half);
    let highlight = if along > 0.0 { libm::pow(along.into(), material.shininess.into()) as f32 } else { 0.0 };
    light.at(distance) * (material.diffuse * facing + material.specular * highlight)
}

fn balance(colour: Vec3) -> Vec3 {
    let largest = colour.max_element();
    let colour = if largest > 1.0 { colour / largest } else { colour };
    colour.clamp(Vec3::ZERO, Vec3::ONE)
}
