//! Generated ground with any number of triangles.

use glam::Vec3;
use rayon::prelude::*;
use serde::Deserialize;

use super::{flat, halves, noise};
use crate::scene::Model;

/// Height of the widest hills. Each further octave halves the height and the width of the hills.
const HEIGHT: f32 = 0.2;

/// Number of hills of the first octave along one side.
const HILLS: f32 = 4.0;

/// Ground over the square from -1 to 1 in x and z. The last row of cells may be incomplete or missing. More triangles
/// add smaller hills. The larger hills do not change.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Terrain {
    /// The exact number of triangles, from 1 to [`Terrain::MOST`].
    pub triangles: usize,
    #[serde(default = "one")]
    pub seed: u32,
}

fn one() -> u32 {
    1
}

impl Terrain {
    /// A mesh of this size needs some gigabytes of memory.
    pub const MOST: usize = 1 << 27;

    pub fn model(self) -> Model {
        let cells = self.triangles.div_ceil(2);
        let columns = cells.isqrt() + usize::from(cells.isqrt() * cells.isqrt() < cells);
        let rows = cells.div_ceil(columns);
        // Hills narrower than two cells would be sampled too coarsely.
        let octaves = (0..).take_while(|&k| HILLS * (1 << k) as f32 <= columns as f32 / 2.0).count().max(1) as u32;
        let across = columns + 1;
        let vertex = |i: usize| {
            let at = |step: usize| 2.0 * (step as f64 / columns as f64) as f32 - 1.0;
            let (x, z) = (at(i % across), at(i / across));
            Vec3::new(x, height(x, z, octaves, self.seed), z)
        };
        let corner = |column: usize, row: usize| (row * across + column) as u32;
        let triangle = |i: usize| {
            let (left, far) = (i / 2 % columns, i / 2 / columns);
            let (right, near) = (left + 1, far + 1);
            halves([corner(left, near), corner(right, near), corner(right, far), corner(left, far)])[i % 2]
        };
        let vertices = (0..across * (rows + 1)).into_par_iter().map(vertex);
        flat(vertices.collect(), (0..self.triangles).into_par_iter().map(triangle).collect())
    }
}

fn height(x: f32, z: f32, octaves: u32, seed: u32) -> f32 {
    let octave = |k: u32| {
        let finer = (1_u32 << k) as f32;
        let at = Vec3::new(x, 0.0, z) * (HILLS / 2.0 * finer);
        noise::smooth(at, seed.wrapping_mul(64).wrapping_add(k)) * (HEIGHT / finer)
    };
    (0..octaves).map(octave).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Mesh;

    fn terrain(triangles: usize, seed: u32) -> Model {
        Terrain { triangles, seed }.model()
    }

    #[test]
    fn every_number_of_triangles_is_a_ground_without_gaps_that_looks_up() {
        for count in [1, 2, 3, 7, 8, 50, 1001, 20_000] {
            let model = terrain(count, 1);
            let mesh = Mesh::new(model.positions, model.triangles).unwrap();
            assert!(mesh.len() == count && mesh.degenerate().is_empty(), "{count}");
            let above = |[a, b, c]: [Vec3; 3]| (b - a).cross(c - a).y / 2.0;
            let areas: Vec<f32> = (0..count as u32).map(|i| above(mesh.corners(i))).collect();
            let side = ((count as f32 / 2.0).ceil().sqrt()).ceil();
            let half_a_cell = 2.0 / (side * side);
            assert!(areas.iter().all(|&area| (area / half_a_cell - 1.0).abs() < 1e-2), "{count}: {areas:?}");
        }
    }

    #[test]
    fn equal_seeds_make_equal_grounds_and_others_do_not() {
        let heights = |seed| terrain(5000, seed).positions.iter().map(|p| p.y).collect::<Vec<f32>>();
        assert_eq!(heights(1), heights(1));
        assert_ne!(heights(1), heights(2));
    }
}
