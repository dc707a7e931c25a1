//! The meshes of the hard cases.

use std::sync::Arc;

use glam::Vec3;

use crate::geometry::Mesh;
use crate::scene::meshes;
use crate::validate::Sampler;
use crate::validate::degenerate::{TRIANGLE, box_grid, mesh, soup_triangles};

pub(super) fn indexed(points: Vec<Vec3>, triangles: Vec<[u32; 3]>) -> Arc<Mesh> {
    Arc::new(Mesh::new(points, triangles).expect("made of finite numbers"))
}

pub(super) fn moved(mesh: &Mesh, to: impl Fn(Vec3) -> Vec3) -> Arc<Mesh> {
    indexed(mesh.positions().iter().copied().map(to).collect(), mesh.triangles().to_vec())
}

pub(super) fn joined(one: &Mesh, other: &Mesh) -> Arc<Mesh> {
    let first = one.positions().len() as u32;
    let moved_on = other.triangles().iter().map(|corners| corners.map(|corner| first + corner));
    indexed([one.positions(), other.positions()].concat(), one.triangles().iter().copied().chain(moved_on).collect())
}

/// Rotates `p` by a nearly orthogonal matrix. The length of `p` changes by less than 1 %.
pub(super) fn tilted(p: Vec3) -> Vec3 {
    const AXES: [Vec3; 3] = [
        Vec3::new(0.754_406_5, -0.304_113_5, 0.581_715_7),
        Vec3::new(0.633_718_1, 0.594_353_7, -0.511_118_2),
        Vec3::new(-0.190_308_2, 0.754_230_6, 0.628_429_6),
    ];
    AXES[0] * p.x + AXES[1] * p.y + AXES[2] * p.z
}

/// A closed sphere of radius 1. Neighbouring triangles share corners bit for bit.
pub(super) fn sphere() -> Arc<Mesh> {
    let model = meshes::uv_sphere(50, 50);
    indexed(model.positions, model.triangles)
}

/// The closed star of pbrt's test `Triangle.Watertight`. Points within 0.9 of the origin are inside.
pub(super) fn star() -> Arc<Mesh> {
    let mut sampler = Sampler::new(1);
    let [top, bottom, ..]: [f32; 2] = std::array::from_fn(|_| 1.0 + 5.0 * sampler.unit());
    let sphere = meshes::uv_sphere(32, 32);
    let points = sphere.positions.iter().map(|&p| {
        // All vertices of a pole coincide, so they need the same radius.
        let pole = p.x == 0.0 && p.z == 0.0;
        let radius = 1.0 + 5.0 * sampler.unit();
        p * match p.y > 0.0 {
            _ if !pole => radius,
            true => top,
            false => bottom,
        }
    });
    indexed(points.collect(), sphere.triangles)
}

pub(super) fn star_times(scale: f32) -> Arc<Mesh> {
    moved(&star(), |p| p * scale)
}

/// `n` by `n` squares in the plane z = 0, from -1 to 1 along x and y.
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

/// The surface of the cube [-1, 1]^3. Coordinates are multiples of 1/8. Normals point outward.
pub(super) fn cube() -> Arc<Mesh> {
    let grid = box_grid(16);
    let outward = |&[i, j, k]: &[u32; 3]| {
        let [a, b, c] = [i, j, k].map(|index| grid.positions()[index as usize]);
        if (b - a).cross(c - a).dot(a) > 0.0 { [i, j, k] } else { [i, k, j] }
    };
    indexed(grid.positions().to_vec(), grid.triangles().iter().map(outward).collect())
}

pub(super) fn strips() -> Arc<Mesh> {
    let points = (0..=1000).flat_map(|i| [0.0, 1000.0].map(|x| Vec3::new(x, i as f32 * 1e-3, 0.0)));
    let strips = (0..1000).map(|i| 2 * i).flat_map(|a: u32| [[a, a + 1, a + 3], [a, a + 3, a + 2]]);
    indexed(points.collect(), strips.collect())
}

pub(super) fn hair() -> Arc<Mesh> {
    let mut sampler = Sampler::new(13);
    mesh((0..3000).map(|_| {
        let root = sampler.cube() * 2.0;
        [root, root + Vec3::splat(2.0 / 1.732_050_8), root + sampler.direction() * 1e-3]
    }))
}

pub(super) fn fan() -> Arc<Mesh> {
    let fan = meshes::fan(800);
    indexed(fan.positions, fan.triangles)
}

pub(super) fn copies(copies: usize) -> Arc<Mesh> {
    mesh(std::iter::repeat_n(TRIANGLE, copies))
}

pub(super) fn ulp_copies() -> Arc<Mesh> {
    let mut sampler = Sampler::new(23);
    let mut shift = |x: f32| match sampler.below(3) {
        0 => x.next_down(),
        1 => x,
        _ => x.next_up(),
    };
    mesh((0..500).map(|_| TRIANGLE.map(|p| Vec3::from_array(p.to_array().map(&mut shift)))))
}

/// Triangles along the x axis. Every fourth triangle is a sliver. All other triangles have no area.
pub(super) fn line() -> Arc<Mesh> {
    let on_line = |i: usize, step: f32| Vec3::new(i as f32 * 0.125 + step, 0.0, 0.0);
    mesh((0..400).map(|i| {
        let lift = if i % 4 == 0 { Vec3::Z * 0.001 } else { Vec3::ZERO };
        [on_line(i, 0.0), on_line(i, 1.0), on_line(i, 0.5) + lift]
    }))
}

pub(super) fn mostly_centred() -> Arc<Mesh> {
    let mut sampler = Sampler::new(26);
    let alike = (0..1400).map(|_| {
        // Small multiples of 1/64 add without rounding, so the centroid is exactly zero.
        let [a, b] = [0; 2].map(|_| (sampler.cube() * 64.0).round() / 64.0);
        [a, b, -a - b]
    });
    mesh(alike.chain(soup_triangles(600, 26)))
}

pub(super) fn pot() -> Arc<Mesh> {
    let model = meshes::teapot();
    moved(&indexed(model.positions, model.triangles), |p| p * 0.04)
}

pub(super) fn largest_numbers() -> Arc<Mesh> {
    let mut sampler = Sampler::new(39);
    let far = |sampler: &mut Sampler| Vec3::new(sampler.sign(), sampler.sign(), sampler.sign()) * f32::MAX;
    mesh(soup_triangles(300, 39).enumerate().map(|(i, [a, b, c])| match i % 10 {
        0 => [far(&mut sampler), b, c],
        1 => [far(&mut sampler), far(&mut sampler), c],
        _ => [a, b, c],
    }))
}

pub(super) fn deep_chain() -> Arc<Mesh> {
    mesh((-60..=60).map(|exponent| {
        let at = libm::scalbnf(1.0, exponent);
        [Vec3::new(at, -at, -at), Vec3::new(at, 2.0 * at, -at), Vec3::new(at, -at, 2.0 * at)]
    }))
}
