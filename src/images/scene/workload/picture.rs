//! All rays of a picture, sorted by pixel and then by recursion level.

use super::bounces::{SurfaceHit, surface_hits};
use super::primary;
use super::source::Source;
use crate::geometry::Ray;
use crate::scene::View;

pub fn closest(source: &mut Source) -> Vec<Ray> {
    let primary = primary::by_row(source, View::CENTRE);
    let mut rays: Vec<(usize, Ray)> = primary.iter().copied().enumerate().collect();
    walk(source, primary, |pixel, _, mirrored| rays.extend(mirrored.map(|ray| (pixel, ray))));
    by_pixel(rays)
}

pub fn shadow(source: &mut Source) -> Vec<Ray> {
    let (scene, mut rays) = (source.scene, vec![]);
    walk(source, primary::by_row(source, View::CENTRE), |pixel, h, _| {
        rays.extend(scene.lights.iter().map(|light| (pixel, scene.shadow_ray(h.hit.prim, &h.surface, light))));
    });
    by_pixel(rays)
}

/// Calls `visit` for every hit, level by level, with the pixel, the hit and the mirror ray.
fn walk(source: &Source, primary: Vec<Ray>, mut visit: impl FnMut(usize, &SurfaceHit, Option<Ray>)) {
    let Source { scene, accel, .. } = source;
    let mut pixels: Vec<usize> = (0..primary.len()).collect();
    let mut rays = primary;
    for level in 0..=scene.recursion_limit {
        let mut next = vec![];
        for hit in surface_hits(scene, &rays, *accel) {
            let casts = level < scene.recursion_limit && scene.material(hit.hit.prim).mirror > 0.0;
            let mirrored = casts.then(|| scene.mirror_ray(&hit.ray, &hit.surface));
            let pixel = pixels[hit.number];
            visit(pixel, &hit, mirrored);
            next.extend(mirrored.map(|ray| (pixel, ray)));
        }
        (pixels, rays) = next.into_iter().unzip();
    }
}

/// The stable sort keeps the rays of a pixel in the order of the levels.
fn by_pixel(mut rays: Vec<(usize, Ray)>) -> Vec<Ray> {
    rays.sort_by_key(|&(pixel, _)| pixel);
    rays.into_iter().map(|(_, ray)| ray).collect()
}
