//! Meshes and rays of a case, and the shapes that several families share.

use std::sync::Arc;

use glam::Vec3;

use crate::geometry::{Mesh, Ray};
use crate::scene::meshes::uv_sphere;
use crate::validate::Sampler;
use crate::validate::degenerate::box_grid;

/// What a case traces.
#[derive(Clone, Debug)]
pub struct Set {
    pub mesh: Arc<Mesh>,
    pub rays: Vec<Ray>,
    /// Ordinary rays over the same mesh, where the time of invalid ones is to be told against theirs; otherwise none.
    pub ordinary: Vec<Ray>,
}

impl Set {
    /// `count` rays over `mesh`, drawn from random numbers of their own.
    pub(super) fn new(mesh: Arc<Mesh>, count: usize, seed: u64, mut ray: impl FnMut(&mut Sampler) -> Ray) -> Self {
        let mut sampler = Sampler::new(seed);
        let rays = (0..count).map(|_| ray(&mut sampler)).collect();
        Self { mesh, rays, ordinary: vec![] }
    }
}

pub(super) fn ray_to(origin: Vec3, target: Vec3) -> Ray {
    Ray::new(origin, target - origin)
}

pub(super) fn indexed(points: Vec<Vec3>, triangles: Vec<[u32; 3]>) -> Arc<Mesh> {
    Arc::new(Mesh::new(points, triangles).expect("made of finite numbers"))
}

pub(super) fn moved(mesh: &Mesh, to: impl Fn(Vec3) -> Vec3) -> Arc<Mesh> {
    indexed(mesh.positions().iter().copied().map(to).collect(), mesh.triangles().to_vec())
}

/// All of `one`, then all of `other`.
pub(super) fn joined(one: &Mesh, other: &Mesh) -> Arc<Mesh> {
    let first = one.positions().len() as u32;
    let moved_on = other.triangles().iter().map(|corners| corners.map(|corner| first + corner));
    indexed([one.positions(), other.positions()].concat(), one.triangles().iter().copied().chain(moved_on).collect())
}

/// A closed sphere of meridians and parallels, radius 1: neighbours have the same corners bit for bit.
pub(super) fn sphere(segments: u32, bands: u32) -> Arc<Mesh> {
    let model = uv_sphere(segments, bands);
    indexed(model.positions, model.triangles)
}

/// The closed star of pbrt's watertight test: a sphere of 32 meridians and parallels whose vertices lie at random radii of 1 to 6.
/// Whatever is nearer to zero than 0.9 is inside.
pub(super) fn star() -> Arc<Mesh> {
    let mut sampler = Sampler::new(1);
    let [top, bottom, ..]: [f32; 2] = std::array::from_fn(|_| 1.0 + 5.0 * sampler.unit());
    let sphere = sphere(32, 32);
    let points = sphere.positions().iter().map(|&p| {
        // The vertices of a pole are one point.
        let pole = p.x == 0.0 && p.z == 0.0;
        let radius = 1.0 + 5.0 * sampler.unit();
        p * match p.y > 0.0 {
            _ if !pole => radius,
            true => top,
            false => bottom,
        }
    });
    indexed(points.collect(), sphere.triangles().to_vec())
}

/// A point inside the star, at most half a unit from zero.
pub(super) fn inside(sampler: &mut Sampler) -> Vec3 {
    sampler.direction() * (0.5 * sampler.unit())
}

/// `n` by `n` squares of side `2 / n` in the plane z = 0, from -1 to 1.
pub(super) fn sheet(n: u32) -> Arc<Mesh> {
    let at = |i: u32| 2.0 * i as f32 / n as f32 - 1.0;
    let points = (0..=n).flat_map(|j| (0..=n).map(move |i| Vec3::new(at(i), at(j), 0.0))).collect();
    let vertex = |i: u32, j: u32| j * (n + 1) + i;
    let cells = (0..n).flat_map(|j| (0..n).map(move |i| (i, j)));
    let triangles = cells.flat_map(|(i, j)| {
        let [a, b, c, d] = [vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1), vertex(i, j + 1)];
        [[a, b, c], [a, c, d]]
    });
    indexed(points, triangles.collect())
}

/// The cube [-1, 1]^3 of a grid of `n` by `n` squares a side, every triangle wound so that its front looks outward.
pub(super) fn cube(n: usize) -> Arc<Mesh> {
    let grid = box_grid(n);
    let outward = |&[i, j, k]: &[u32; 3]| {
        let [a, b, c] = [i, j, k].map(|index| grid.positions()[index as usize]);
        if (b - a).cross(c - a).dot(a) > 0.0 { [i, j, k] } else { [i, k, j] }
    };
    indexed(grid.positions().to_vec(), grid.triangles().iter().map(outward).collect())
}

/// A rotation without simple numbers: three perpendicular unit vectors up to rounding.
pub(super) fn tilted(p: Vec3) -> Vec3 {
    const AXES: [Vec3; 3] = [
        Vec3::new(0.754_406_5, -0.304_113_5, 0.581_715_7),
        Vec3::new(0.633_718_1, 0.594_353_7, -0.511_118_2),
        Vec3::new(-0.190_308_2, 0.754_230_6, 0.628_429_6),
    ];
    AXES[0] * p.x + AXES[1] * p.y + AXES[2] * p.z
}

pub(super) fn triangle(mesh: &Mesh, sampler: &mut Sampler) -> [Vec3; 3] {
    loop {
        let index = sampler.below(mesh.len()) as u32;
        if !mesh.is_degenerate(index) {
            return mesh.corners(index);
        }
    }
}

pub(super) fn on_edge(mesh: &Mesh, sampler: &mut Sampler) -> Vec3 {
    let [a, b, _] = triangle(mesh, sampler);
    a.lerp(b, sampler.unit())
}

pub(super) fn on_surface(mesh: &Mesh, sampler: &mut Sampler) -> Vec3 {
    let ([a, b, c], [u, v, w]) = (triangle(mesh, sampler), sampler.barycentric());
    a * u + b * v + c * w
}
