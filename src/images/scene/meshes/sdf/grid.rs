//! Samples a signed distance function on a grid of cubic cells.

use glam::{UVec3, Vec3};
use rayon::prelude::*;

use super::{Active, Sdf};
use crate::geometry::Aabb;

const BLOCK: usize = 8;

/// Distances at grid points. Far from the surface, only the sign of a distance is correct.
pub struct Grid {
    pub origin: Vec3,
    pub step: f32,
    pub size: [usize; 3],
    pub values: Vec<f32>,
    blocks: [usize; 3],
    active: Vec<Active>,
}

impl Grid {
    /// The grid extends beyond `bounds` by at least two steps on each side.
    pub fn sample(sdf: &Sdf, bounds: Aabb, step: f32) -> Self {
        let origin = bounds.min - Vec3::splat(2.0 * step);
        let cells = (bounds.extent() / step).ceil().as_uvec3() + UVec3::splat(4);
        let blocks = cells.to_array().map(|n| (n as usize + 1).div_ceil(BLOCK));
        let size = blocks.map(|n| n * BLOCK);

        let mut values = vec![0.0; size[0] * size[1] * size[2]];
        let layer_size = size[0] * size[1] * BLOCK;
        let fill = |(z, layer): (usize, &mut [f32])| -> Vec<Active> {
            let places = (0..blocks[1]).flat_map(|y| (0..blocks[0]).map(move |x| [x, y, z]));
            places.map(|block| fill_block(sdf, origin, step, block, size, layer)).collect()
        };
        let active = values.par_chunks_mut(layer_size).enumerate().map(fill).flatten_iter().collect();
        Self { origin, step, size, values, blocks, active }
    }

    pub fn index(&self, [x, y, z]: [usize; 3]) -> usize {
        (z * self.size[1] + y) * self.size[0] + x
    }

    pub fn place(&self, at: [usize; 3]) -> Vec3 {
        self.origin + Vec3::from(at.map(|n| n as f32)) * self.step
    }

    pub fn active(&self, p: Vec3) -> &Active {
        let at = ((p - self.origin) / self.step).max(Vec3::ZERO).as_uvec3().to_array();
        let [x, y, z] = [0, 1, 2].map(|i| (at[i] as usize / BLOCK).min(self.blocks[i] - 1));
        &self.active[(z * self.blocks[1] + y) * self.blocks[0] + x]
    }

    fn corners(&self, cell: [usize; 3]) -> u8 {
        (0..8).fold(0, |mask, i| mask | u8::from(self.values[self.index(corner(cell, i))] < 0.0) << i)
    }

    /// The cells that the surface crosses, in ascending order.
    pub fn cells(&self) -> Vec<[usize; 3]> {
        let [nx, ny, nz] = self.size;
        let layer = |z| (0..ny - 1).flat_map(move |y| (0..nx - 1).map(move |x| [x, y, z]));
        let passed = |cell: &[usize; 3]| !matches!(self.corners(*cell), 0 | u8::MAX);
        (0..nz - 1).into_par_iter().flat_map_iter(|z| layer(z).filter(passed)).collect()
    }

    /// Turns outside grid points into inside points until no cell contains two pieces of the surface. A mesh with one
    /// vertex per cell is then a closed two-manifold. Inside points stay inside, so the loop terminates.
    pub fn simplify(&mut self) {
        let simple: Vec<bool> = (0..=255).map(|mask| connected(mask) && connected(!mask)).collect();
        let mut queue = self.cells();
        while let Some(cell) = queue.pop() {
            if simple[self.corners(cell) as usize] {
                continue;
            }
            let value = |at: &[usize; 3]| self.values[self.index(*at)];
            let outside = (0..8).map(|i| corner(cell, i)).filter(|at| value(at) >= 0.0);
            let nearest = outside.min_by(|a, b| value(a).total_cmp(&value(b)));
            let nearest = nearest.expect("a cell without a corner outside is simple");
            let index = self.index(nearest);
            self.values[index] = -0.01 * self.step;
            let before = nearest.map(|n| n - 1);
            queue.extend((0..8).rev().map(|i| corner(before, i)));
        }
    }
}

pub fn corner([x, y, z]: [usize; 3], i: usize) -> [usize; 3] {
    [x + (i & 1), y + (i >> 1 & 1), z + (i >> 2)]
}

fn fill_block(sdf: &Sdf, origin: Vec3, step: f32, block: [usize; 3], size: [usize; 3], layer: &mut [f32]) -> Active {
    let first = origin + Vec3::from(block.map(|b| (b * BLOCK) as f32)) * step;
    let half = 0.5 * (BLOCK - 1) as f32 * step;
    let radius = half * 1.733;
    let active = sdf.near(first + half, radius + 3.0 * step);

    // A block far from the surface contains no change of sign.
    let middle = sdf.undisplaced_distance(&active, first + half).0;
    let far = middle.abs() > 2.0 * radius + 3.0 * sdf.highest;
    for z in 0..BLOCK {
        for y in 0..BLOCK {
            let row = (z * size[1] + block[1] * BLOCK + y) * size[0] + block[0] * BLOCK;
            for x in 0..BLOCK {
                let p = first + Vec3::from([x, y, z].map(|n| n as f32)) * step;
                layer[row + x] = if far { middle } else { sdf.distance(&active, p) };
            }
        }
    }
    active
}

/// Whether the corners in `mask` are connected along the edges of a cube.
fn connected(mask: u8) -> bool {
    let mut reached = mask & mask.wrapping_neg();
    // Each round adds one edge to the paths. No path needs more than seven edges.
    for _ in 0..8 {
        let neighbours = (0..8).filter(|c| reached >> c & 1 == 1).flat_map(|c| [1, 2, 4].map(|axis| 1 << (c ^ axis)));
        reached |= mask & neighbours.fold(0, |all, corner: u8| all | corner);
    }
    reached == mask
}
