//! Rays that do not depend on the camera: random lines and lines along the axes.

use glam::{DVec3, Vec3};

use super::source::Source;
use crate::geometry::Ray;
use crate::scene::Scene;

pub fn random(source: &mut Source) -> Vec<Ray> {
    let Some((centre, radius)) = sphere(source.scene) else { return vec![] };
    let mut ray = || loop {
        let (from, to) = (source.sampler.direction(), source.sampler.direction());
        if let Some(direction) = (to - from).try_normalize() {
            break Ray::new((centre + from * radius).as_vec3(), direction.as_vec3());
        }
    };
    (0..source.sampling.pixels()).map(|_| ray()).collect()
}

/// Every fourth row and column of the ray lattice lies at a vertex coordinate. These rays are likely to pass through
/// vertices, along edges and in the planes of triangles.
pub fn axis(source: &mut Source) -> Vec<Ray> {
    let scene = source.scene;
    let Some((centre, radius)) = sphere(scene) else { return vec![] };
    let side = (source.sampling.pixels() / 6).isqrt().max(1);
    let mut rays = vec![];
    for axis in 0..3 {
        let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
        for way in [1.0f32, -1.0] {
            let mut direction = Vec3::ZERO;
            direction[axis] = way;
            for j in 0..side {
                for i in 0..side {
                    let mut origin = Vec3::ZERO;
                    origin[axis] = (centre[axis] - f64::from(way) * radius) as f32;
                    origin[u] = line(scene, u, i, side);
                    origin[v] = line(scene, v, j, side);
                    rays.push(Ray::new(origin, direction));
                }
            }
        }
    }
    rays
}

fn line(scene: &Scene, axis: usize, i: u32, side: u32) -> f32 {
    let positions = scene.mesh.positions();
    if i.is_multiple_of(4) {
        let vertex = (u64::from(i) * positions.len() as u64 / u64::from(side)) as usize;
        return positions[vertex][axis];
    }
    let bounds = scene.mesh.bounds();
    let (min, max) = (f64::from(bounds.min[axis]), f64::from(bounds.max[axis]));
    (min + (max - min) * (f64::from(i) + 0.5) / f64::from(side)) as f32
}

fn sphere(scene: &Scene) -> Option<(DVec3, f64)> {
    let bounds = scene.mesh.bounds();
    let (min, max) = (bounds.min.as_dvec3(), bounds.max.as_dvec3());
    (!bounds.is_empty()).then(|| ((min + max) * 0.5, (max - min).length() * 0.5))
}
