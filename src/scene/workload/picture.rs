//! All rays of a picture, ordered by pixel, a pixel's in the order of their levels.

use super::super::Scene;
use super::bounce::{Landed, land, to_lights};
use crate::accel::DynAccel;
use crate::geometry::Ray;

pub fn closest(scene: &Scene, primary: &[Ray], accel: &dyn DynAccel) -> Vec<Ray> {
    let mut rays: Vec<(usize, Ray)> = primary.iter().copied().enumerate().collect();
    walk(scene, primary, accel, |pixel, _, mirrored| rays.extend(mirrored.map(|ray| (pixel, ray))));
    by_pixel(rays)
}

pub fn shadow(scene: &Scene, primary: &[Ray], accel: &dyn DynAccel) -> Vec<Ray> {
    let mut rays = vec![];
    walk(scene, primary, accel, |pixel, landed, _| rays.extend(to_lights(scene, landed).map(|ray| (pixel, ray))));
    by_pixel(rays)
}

/// Shows every hit with its pixel and the mirror ray that leaves it.
fn walk(scene: &Scene, primary: &[Ray], accel: &dyn DynAccel, mut visit: impl FnMut(usize, &Landed, Option<Ray>)) {
    let mut pixels: Vec<usize> = (0..primary.len()).collect();
    let mut rays = primary.to_vec();
    for level in 0..=scene.recursion_limit {
        let mut next = vec![];
        for landed in land(scene, &rays, accel) {
            let casts = level < scene.recursion_limit && scene.material(landed.hit.prim).mirror > 0.0;
            let mirrored = casts.then(|| scene.mirror_ray(&landed.ray, &landed.surface));
            let pixel = pixels[landed.number];
            visit(pixel, &landed, mirrored);
            next.extend(mirrored.map(|ray| (pixel, ray)));
        }
        (pixels, rays) = next.into_iter().unzip();
    }
}

/// A stable sort keeps the levels of a pixel in order.
fn by_pixel(mut rays: Vec<(usize, Ray)>) -> Vec<Ray> {
    rays.sort_by_key(|&(pixel, _)| pixel);
    rays.into_iter().map(|(_, ray)| ray).collect()
}
