//! Small meshes that break builders and traversals.

use std::sync::Arc;

use glam::Vec3;

use super::Sampler;
use crate::geometry::Mesh;

pub fn degenerate_meshes() -> Vec<(String, Arc<Mesh>)> {
    let mut meshes: Vec<(String, Arc<Mesh>)> = vec![
        ("one triangle".into(), mesh([TRIANGLE])),
        ("200 coincident".into(), mesh([TRIANGLE; 200])),
        ("2000 coincident".into(), mesh([TRIANGLE; 2000])),
        ("coplanar, axis-aligned".into(), coplanar(200, Vec3::X, Vec3::Y)),
        ("coplanar, tilted".into(), coplanar(200, Vec3::new(0.9, 0.1, 0.3), Vec3::new(-0.2, 0.8, 0.7))),
        ("half without area".into(), half_without_area(200)),
        ("only without area".into(), mesh([[Vec3::ONE; 3], [Vec3::ZERO, Vec3::ONE, Vec3::splat(2.0)]])),
        ("crossing needles".into(), needles(300)),
        ("nested shells".into(), shells()),
        ("exponential sequence".into(), exponential(300)),
        ("box of a grid".into(), box_grid(4)),
        ("same centroid".into(), same_centroid(300)),
        ("a huge triangle and small ones".into(), huge_and_small()),
        ("far from zero".into(), mesh(soup_triangles(200, 3).map(|t| t.map(|p| p + FAR)))),
        ("soup".into(), soup(500, 1)),
        ("closed sphere".into(), sphere(3)),
    ];
    meshes.extend((0..=40).map(|n| (format!("{n} random"), soup(n, 100 + n as u64))));
    for (exponent, name) in [(-30, "soup times 2^-30"), (30, "soup times 2^30")] {
        let scale = libm::scalbnf(1.0, exponent);
        meshes.push((name.into(), mesh(soup_triangles(100, 2).map(|t| t.map(|p| p * scale)))));
    }
    meshes
}

const FAR: Vec3 = Vec3::new(148_376.0, 1234.0, -223_423.0);

/// A ray can cross the boxes of all sheets, so traversals need a deep stack.
pub fn stacked_sheets() -> Vec<(String, Arc<Mesh>)> {
    vec![("8192 stacked sheets".into(), sheets(8192))]
}

pub(crate) fn sheets(count: u16) -> Arc<Mesh> {
    mesh((0..count).map(|i| TRIANGLE.map(|p| p + Vec3::Z * (2.0 * f32::from(i) / f32::from(count)))))
}

pub(crate) const TRIANGLE: [Vec3; 3] =
    [Vec3::new(-1.0, -0.5, 0.25), Vec3::new(1.5, -0.75, 0.5), Vec3::new(0.25, 1.0, -0.5)];

pub(crate) fn mesh(triangles: impl IntoIterator<Item = [Vec3; 3]>) -> Arc<Mesh> {
    let triangles: Vec<[Vec3; 3]> = triangles.into_iter().collect();
    Arc::new(Mesh::from_triangles(&triangles).expect("made of finite numbers"))
}

pub(crate) fn soup_triangles(n: usize, seed: u64) -> impl Iterator<Item = [Vec3; 3]> {
    let mut sampler = Sampler::new(seed);
    (0..n).map(move |_| {
        let centre = sampler.cube();
        std::array::from_fn(|_| centre + sampler.cube() * 0.2)
    })
}

pub(crate) fn soup(n: usize, seed: u64) -> Arc<Mesh> {
    mesh(soup_triangles(n, seed))
}

pub(crate) fn coplanar(n: usize, u: Vec3, v: Vec3) -> Arc<Mesh> {
    let mut sampler = Sampler::new(4);
    mesh((0..n).map(|_| {
        let (x, y) = (sampler.signed() * 3.0, sampler.signed() * 3.0);
        std::array::from_fn(|_| u * (x + sampler.signed()) + v * (y + sampler.signed()))
    }))
}

/// Every second triangle has no area.
pub(crate) fn half_without_area(n: usize) -> Arc<Mesh> {
    let mut sampler = Sampler::new(5);
    mesh(soup_triangles(n, 5).enumerate().map(|(i, [a, b, c])| match i % 6 {
        0 => [a, a, a],
        2 => [a, b, b],
        4 => {
            let step = sampler.pick(&[Vec3::X, Vec3::new(0.5, 0.25, -1.0), Vec3::ONE]);
            let start = (a * 8.0).round();
            [start, start + step, start + step * 2.0]
        }
        _ => [a, b, c],
    }))
}

/// Long thin triangles through the origin. No partition separates their boxes.
pub(crate) fn needles(n: usize) -> Arc<Mesh> {
    let mut sampler = Sampler::new(6);
    mesh((0..n).map(|_| {
        let along = sampler.direction() * 10.0;
        let across = sampler.direction() * 0.01;
        [-along, along, along + across]
    }))
}

pub(crate) fn shells() -> Arc<Mesh> {
    mesh((-30..=30).flat_map(|exponent| {
        let r = libm::scalbnf(1.0, exponent);
        octahedron().map(move |t| t.map(|p| p * r))
    }))
}

pub(crate) fn octahedron() -> impl Iterator<Item = [Vec3; 3]> {
    (0..8).map(|octant: u32| {
        let sign = |axis: u32| if octant >> axis & 1 == 1 { -1.0 } else { 1.0 };
        [Vec3::X * sign(0), Vec3::Y * sign(1), Vec3::Z * sign(2)]
    })
}

/// Sizes and x coordinates grow by a factor of 1.3 per triangle. A split in the middle separates few triangles.
pub(crate) fn exponential(n: usize) -> Arc<Mesh> {
    let mut at = 1e-16_f32;
    mesh((0..n).map(|_| {
        at *= 1.3;
        [Vec3::new(at, 0.0, 0.0), Vec3::new(at * 1.2, at, 0.0), Vec3::new(at * 1.1, 0.0, at)]
    }))
}

/// The surface of the cube [-1, 1]^3. Each face has `n` by `n` squares of two triangles.
pub(crate) fn box_grid(n: usize) -> Arc<Mesh> {
    let mut triangles = vec![];
    for axis in 0..3 {
        for side in [-1.0, 1.0] {
            for cell in 0..n * n {
                let corner = |i: usize, j: usize| {
                    let at = |k: usize| 2.0 * k as f32 / n as f32 - 1.0;
                    let mut p = Vec3::splat(side);
                    p[(axis + 1) % 3] = at(cell % n + i);
                    p[(axis + 2) % 3] = at(cell / n + j);
                    p
                };
                triangles.push([corner(0, 0), corner(1, 0), corner(1, 1)]);
                triangles.push([corner(0, 0), corner(1, 1), corner(0, 1)]);
            }
        }
    }
    mesh(triangles)
}

/// Triangles with the same centroid. No plane between centroids separates the triangles.
pub(crate) fn same_centroid(n: usize) -> Arc<Mesh> {
    let mut sampler = Sampler::new(7);
    mesh((0..n).map(|_| {
        // Small multiples of 1/1024 add without rounding, so the sum of the corners is exactly zero.
        let [a, b] = [0; 2].map(|_| (sampler.cube() * 1024.0).round() / 1024.0);
        [a, b, -a - b]
    }))
}

pub(crate) fn huge_and_small() -> Arc<Mesh> {
    let huge = TRIANGLE.map(|p| p * 1e6);
    mesh(soup_triangles(200, 8).chain([huge]))
}

/// A closed unit sphere. Neighbouring triangles share corners bit for bit.
fn sphere(levels: usize) -> Arc<Mesh> {
    let mut triangles: Vec<[Vec3; 3]> = octahedron().collect();
    for _ in 0..levels {
        triangles = triangles
            .into_iter()
            .flat_map(|[a, b, c]| {
                let [ab, bc, ca] = [(a, b), (b, c), (c, a)].map(|(p, q)| p + q).map(|p| p / p.length());
                [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
            })
            .collect();
    }
    mesh(triangles)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Ray;
    use crate::oracle::Oracle;

    #[test]
    fn rays_in_the_box_of_a_grid_hit_exactly_the_far_side() {
        let mesh = box_grid(4);
        let oracle = Oracle::new(&mesh);
        let grid = || (-8..=8).map(|k| k as f32 / 8.0);
        for (x, y) in grid().flat_map(|x| grid().map(move |y| (x, y))) {
            for zero in [0.0, -0.0] {
                let truth =
                    oracle.nearest(&Ray::new(Vec3::new(x, y, 0.25), Vec3::new(zero, zero, -0.5))).expect("closed");
                assert_eq!(truth.rounded(), 2.5);
                // An inner vertex of the bottom face belongs to six triangles. An inner edge belongs to two triangles.
                let through = |c: f32| (c * 2.0).fract() == 0.0;
                let inside = x.abs() < 1.0 && y.abs() < 1.0;
                match (through(x), through(y)) {
                    (true, true) if inside => assert_eq!(truth.ids.len(), 6),
                    (true, false) | (false, true) if inside => assert_eq!(truth.ids.len(), 2),
                    _ => assert!(!truth.ids.is_empty()),
                }
            }
        }
    }
}
