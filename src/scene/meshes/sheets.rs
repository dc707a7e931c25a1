//! Layers of perforated sheets: as many surfaces one behind another as one likes, of always as many triangles.

use glam::{DVec3, Vec3};
use rand_core::{RngCore, SeedableRng};
use rand_pcg::Pcg32;

use super::{flat, halves};
use crate::scene::Model;

/// Squares along a side of a single layer: what it is divisible by, the number of layers can be the square of.
pub const SHEET_SIDE: u32 = 240;

/// `root * root` layers in a cube of side 2, each of `240 / root` times as many cells with one square each: 115,200
/// triangles whatever `root` is. A square covers a quarter of its cell, at a random place in it, so that a line through
/// the layers meets a quarter of them. The cube is turned by thirds, so that no layer is parallel to an axis: boxes of
/// its squares have depth.
///
/// # Panics
/// If `root` does not divide [`SHEET_SIDE`].
pub fn sheets(root: u32) -> Model {
    assert!(
        root > 0 && SHEET_SIDE.is_multiple_of(root),
        "the root of the layers divides {SHEET_SIDE}, and {root} does not"
    );
    let (layers, cells) = (root * root, SHEET_SIDE / root);
    let (cell, apart) = (2.0 / f64::from(cells), 2.0 / f64::from(layers));
    let edge = cell / 2.0;
    let mut random = Pcg32::seed_from_u64(u64::from(root));
    let mut share = || f64::from(random.next_u32()) / f64::from(u32::MAX);

    let (mut positions, mut triangles): (Vec<Vec3>, Vec<[u32; 3]>) = (vec![], vec![]);
    for layer in 0..layers {
        let z = -1.0 + apart * (f64::from(layer) + 0.5);
        for number in 0..cells * cells {
            let corner = |i: u32, free: f64| -1.0 + cell * f64::from(i) + free * (cell - edge);
            let (x, y) = (corner(number % cells, share()), corner(number / cells, share()));
            let first = positions.len() as u32;
            let around = [(0.0, 0.0), (edge, 0.0), (edge, edge), (0.0, edge)];
            positions.extend(around.map(|(dx, dy)| turned(DVec3::new(x + dx, y + dy, z)).as_vec3()));
            triangles.extend(halves([0, 1, 2, 3].map(|corner| first + corner)));
        }
    }
    flat(positions, triangles)
}

/// Turned by a matrix of thirds, whose rows have length 1 and stand at right angles.
fn turned(p: DVec3) -> DVec3 {
    DVec3::new(2.0 * p.x - p.y + 2.0 * p.z, 2.0 * p.x + 2.0 * p.y - p.z, -p.x + 2.0 * p.y + 2.0 * p.z) / 3.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_member_has_as_many_triangles_and_as_much_area() {
        for root in [1, 5, 24] {
            let model = sheets(root);
            assert_eq!(model.triangles.len(), 115_200);
            let area = |t: &[u32; 3]| {
                let [a, b, c] = t.map(|i| model.positions[i as usize].as_dvec3());
                (b - a).cross(c - a).length() / 2.0
            };
            // A quarter of each layer, of area 4.
            let total: f64 = model.triangles.iter().map(area).sum();
            assert!((total / f64::from(root * root) - 1.0).abs() < 1e-4, "{root}: {total}");
        }
        assert_eq!(sheets(5).positions, sheets(5).positions);
    }

    #[test]
    fn turning_keeps_lengths() {
        let p = DVec3::new(0.3, -0.7, 0.9);
        assert!((turned(p).length() - p.length()).abs() < 1e-15);
        assert_eq!(turned(DVec3::Z).as_vec3(), Vec3::new(2.0, -1.0, 2.0) / 3.0);
    }
}
