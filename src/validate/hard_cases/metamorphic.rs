//! Scenes changed so that their answers are known from the answers before.

use glam::Vec3;

use super::case::Property;
use super::subject::{built, shared};
use crate::geometry::Ray;
use crate::triangle::{Exact, TriangleTest};
use crate::validate::Sampler;
use crate::validate::conformance::Subject;
use crate::validate::degenerate::mesh;

/// A scene changed so that every `t` stays as it is, or is multiplied by a power of two.
struct Change {
    name: &'static str,
    /// Whether no rounding is different: every test owes the same bits. Otherwise only an exact one does.
    same_rounding: bool,
    mesh: fn(&[[Vec3; 3]]) -> Vec<[Vec3; 3]>,
    ray: fn(Ray) -> Ray,
    /// What `t` is multiplied by.
    factor: f32,
}

/// What a change leaves as it is.
const SAME: Change =
    Change { name: "", same_rounding: false, mesh: |triangles| triangles.to_vec(), ray: |ray| ray, factor: 1.0 };

/// Coordinates of the scene are multiples of 2^-10 below 8: what these changes compute is exact.
const CHANGES: [Change; 7] = [
    Change {
        name: "in another order",
        same_rounding: true,
        mesh: |triangles| triangles.iter().rev().copied().collect(),
        ..SAME
    },
    Change {
        name: "mirrored",
        same_rounding: true,
        mesh: |triangles| each_point(triangles, |p| p * MIRROR),
        ray: |ray| Ray { origin: ray.origin * MIRROR, direction: ray.direction * MIRROR, ..ray },
        ..SAME
    },
    Change {
        name: "1024 times as large",
        same_rounding: true,
        mesh: |triangles| each_point(triangles, |p| p * 1024.0),
        ray: |ray| Ray { origin: ray.origin * 1024.0, ..ray },
        factor: 1024.0,
    },
    Change {
        name: "with axes exchanged",
        mesh: |triangles| each_point(triangles, turned),
        ray: |ray| Ray { origin: turned(ray.origin), direction: turned(ray.direction), ..ray },
        ..SAME
    },
    Change {
        name: "wound the other way",
        mesh: |triangles| triangles.iter().map(|&[a, b, c]| [a, c, b]).collect(),
        ..SAME
    },
    Change {
        name: "moved",
        mesh: |triangles| each_point(triangles, |p| p + SHIFT),
        ray: |ray| Ray { origin: ray.origin + SHIFT, ..ray },
        ..SAME
    },
    Change {
        name: "with every triangle cut in two",
        mesh: |triangles| triangles.iter().flat_map(halves).collect(),
        ..SAME
    },
];

const MIRROR: Vec3 = Vec3::new(-1.0, 1.0, 1.0);
const SHIFT: Vec3 = Vec3::new(32.0, -64.0, 16.0);

fn turned(p: Vec3) -> Vec3 {
    Vec3::new(p.y, p.z, p.x)
}

fn halves(&[a, b, c]: &[Vec3; 3]) -> [[Vec3; 3]; 2] {
    let middle = (b + c) * 0.5;
    [[a, b, middle], [a, middle, c]]
}

fn each_point(triangles: &[[Vec3; 3]], change: fn(Vec3) -> Vec3) -> Vec<[Vec3; 3]> {
    triangles.iter().map(|corners| corners.map(change)).collect()
}

/// Compares the answers to a scene with those to its changes.
pub(super) fn metamorphic(subject: &Subject, rays: usize) -> Result<Property, String> {
    let mut sampler = Sampler::new(75);
    let mut grid = |reach: f32| (sampler.cube() * (reach * 1024.0)).round() / 1024.0;
    let triangles: Vec<[Vec3; 3]> = (0..400)
        .map(|_| {
            let centre = grid(3.0);
            [(); 3].map(|()| centre + grid(1.0))
        })
        .collect();
    let rays: Vec<Ray> = (0..shared(rays, CHANGES.len()))
        .map(|_| {
            let origin = grid(7.0);
            Ray::new(origin, grid(3.0) - origin)
        })
        .collect();

    let plain = built(subject, &mesh(triangles.iter().copied()))?;
    let mut property = Property::default();
    for change in CHANGES.iter().filter(|change| change.same_rounding || subject.triangle_test == Exact::NAME) {
        let changed = built(subject, &mesh((change.mesh)(&triangles)))?;
        for &ray in &rays {
            let expected = plain.closest(&[ray])[0].map(|hit| hit.t * change.factor);
            let found = changed.closest(&[(change.ray)(ray)])[0].map(|hit| hit.t);
            property.note(expected.map(f32::to_bits) == found.map(f32::to_bits), || {
                format!("{}: t is {found:?} and not {expected:?} on the ray \"{ray}\"", change.name)
            });
        }
    }
    Ok(property)
}
