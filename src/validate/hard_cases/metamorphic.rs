//! Compares the hits in a scene with the hits in changed copies of the scene.

use glam::Vec3;

use super::case::Property;
use super::meshes::sheet;
use super::properties::shared;
use crate::accel::BuildError;
use crate::geometry::Ray;
use crate::triangle::{Exact, TriangleTest};
use crate::validate::conformance::Subject;
use crate::validate::degenerate::mesh;
use crate::validate::{Sampler, has_replied};

struct Change {
    name: &'static str,
    /// Whether `f32` arithmetic rounds the same before and after the change. If false, only structures with the
    /// triangle test `Exact` are checked.
    same_rounding: bool,
    triangles: fn(&[[Vec3; 3]]) -> Vec<[Vec3; 3]>,
    /// Moves a vertex or a ray origin.
    point: fn(Vec3) -> Vec3,
    direction: fn(Vec3) -> Vec3,
    /// The new `t` divided by the old `t`, a power of two.
    factor: f32,
}

const SAME: Change = Change {
    name: "",
    same_rounding: false,
    triangles: |triangles| triangles.to_vec(),
    point: |p| p,
    direction: |d| d,
    factor: 1.0,
};

/// All changes are exact for coordinates that are multiples of 2^-10 in [-8, 8].
const CHANGES: [Change; 7] = [
    Change {
        name: "in another order",
        same_rounding: true,
        triangles: |triangles| triangles.iter().rev().copied().collect(),
        ..SAME
    },
    Change { name: "mirrored", same_rounding: true, point: |p| p * MIRROR, direction: |d| d * MIRROR, ..SAME },
    Change { name: "1024 times as large", same_rounding: true, point: |p| p * 1024.0, factor: 1024.0, ..SAME },
    Change { name: "with axes exchanged", point: turned, direction: turned, ..SAME },
    Change { name: "wound the other way", triangles: |all| all.iter().map(|&[a, b, c]| [a, c, b]).collect(), ..SAME },
    Change { name: "moved", point: |p| p + Vec3::new(32.0, -64.0, 16.0), ..SAME },
    Change { name: "with every triangle cut in two", triangles: |all| all.iter().flat_map(halves).collect(), ..SAME },
];

const MIRROR: Vec3 = Vec3::new(-1.0, 1.0, 1.0);

fn turned(p: Vec3) -> Vec3 {
    Vec3::new(p.y, p.z, p.x)
}

fn halves(&[a, b, c]: &[Vec3; 3]) -> [[Vec3; 3]; 2] {
    let middle = (b + c) * 0.5;
    [[a, b, middle], [a, middle, c]]
}

pub(super) fn metamorphic(subject: &Subject, rays: usize) -> Result<Property, BuildError> {
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

    let plain = (subject.build)(&mesh(triangles.iter().copied()))?;
    let mut property = Property::default();
    for change in CHANGES.iter().filter(|change| change.same_rounding || subject.triangle_test == Exact::NAME) {
        let of_change = (change.triangles)(&triangles).into_iter().map(|corners| corners.map(change.point));
        let changed = (subject.build)(&mesh(of_change))?;
        for &ray in &rays {
            let moved = Ray { origin: (change.point)(ray.origin), direction: (change.direction)(ray.direction), ..ray };
            let expected = plain.closest(&[ray])[0].map(|hit| hit.t * change.factor);
            let found = changed.closest(&[moved])[0].map(|hit| hit.t);
            property.note(expected.map(f32::to_bits) == found.map(f32::to_bits), || {
                format!("{}: t is {found:?} and not {expected:?} on the ray \"{ray}\"", change.name)
            });
        }
        has_replied(&*changed)?;
    }
    has_replied(&*plain)?;
    Ok(property)
}

/// Traces rays straight down to inner vertices of a sheet. If the direction (1e-30, 1e-30, -1) hits, the direction
/// (0, 0, -1) must also hit.
pub(super) fn straight_down(subject: &Subject, rays: usize) -> Result<Property, BuildError> {
    let accel = (subject.build)(&sheet(32))?;
    let (mut sampler, mut property) = (Sampler::new(77), Property::default());
    for _ in 0..shared(rays, 4) {
        let inner = |x: usize| (x + 1) as f32 / 16.0 - 1.0;
        let corner = Vec3::new(inner(sampler.below(31)), inner(sampler.below(31)), 0.0);
        let zero = sampler.zero();
        let down = |x: f32| accel.closest(&[Ray::new(corner + Vec3::Z, Vec3::new(x, x, -1.0))])[0].is_some();
        property.note(down(zero) || !down(1e-30), || {
            format!("(1e-30, 1e-30, -1) from {:?} hits the sheet, ({zero:?}, {zero:?}, -1) does not", corner + Vec3::Z)
        });
    }
    has_replied(&*accel)?;
    Ok(property)
}
