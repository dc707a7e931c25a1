//! The mesh and the rays of a hard case.

use std::sync::Arc;

use glam::Vec3;

use crate::geometry::{Mesh, Ray};
use crate::validate::Sampler;

#[derive(Clone, Debug)]
pub struct Set {
    pub mesh: Arc<Mesh>,
    pub rays: Vec<Ray>,
    /// Valid rays, timed for comparison with the invalid `rays`. Empty if `rays` are valid.
    pub ordinary: Vec<Ray>,
}

impl Set {
    pub(super) fn new(
        mesh: Arc<Mesh>,
        count: usize,
        seed: u64,
        mut ray: impl FnMut(&Mesh, &mut Sampler) -> Ray,
    ) -> Self {
        let mut sampler = Sampler::new(seed);
        let rays = (0..count).map(|_| ray(&mesh, &mut sampler)).collect();
        Self { mesh, rays, ordinary: vec![] }
    }
}

pub(super) fn ray_to(origin: Vec3, target: Vec3) -> Ray {
    Ray::new(origin, target - origin)
}

/// A random triangle with an area. `mesh` must contain a triangle with an area.
pub(super) fn triangle(mesh: &Mesh, sampler: &mut Sampler) -> [Vec3; 3] {
    loop {
        let index = sampler.below(mesh.len()) as u32;
        if !mesh.is_degenerate(index) {
            return mesh.corners(index);
        }
    }
}

pub(super) fn vertex(mesh: &Mesh, sampler: &mut Sampler) -> Vec3 {
    let corners = triangle(mesh, sampler);
    sampler.pick(&corners)
}

pub(super) fn on_edge(mesh: &Mesh, sampler: &mut Sampler) -> Vec3 {
    let [a, b, _] = triangle(mesh, sampler);
    a.lerp(b, sampler.unit())
}

pub(super) fn on_surface(mesh: &Mesh, sampler: &mut Sampler) -> Vec3 {
    let corners = triangle(mesh, sampler);
    sampler.point_of(corners)
}
