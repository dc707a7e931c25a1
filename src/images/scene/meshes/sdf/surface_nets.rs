//! Converts signed distance functions to triangles by surface nets.
//!
//! # References
//! Gibson: Constrained elastic surface nets. 1998.

use glam::Vec3;
use rayon::prelude::*;

use super::Sdf;
use super::grid::{Grid, corner};
use crate::geometry::Aabb;
use crate::scene::{Model, meshes::normals};

impl Sdf {
    /// Returns the largest connected piece of the surface. The mesh is closed. The edges are about `step` long.
    pub fn surface(&self, bounds: Aabb, step: f32, relax: usize) -> Model {
        let mut grid = Grid::sample(self, bounds, step);
        grid.simplify();
        let (mut positions, quads) = net(&grid);
        for _ in 0..relax {
            positions = relaxed(self, &grid, &positions, &quads);
        }

        let mut triangles = Vec::with_capacity(2 * quads.len());
        for [a, b, c, d] in quads {
            let [pa, pb, pc, pd] = [a, b, c, d].map(|i| positions[i as usize]);
            if pa.distance_squared(pc) <= pb.distance_squared(pd) {
                triangles.extend([[a, b, c], [a, c, d]]);
            } else {
                triangles.extend([[a, b, d], [b, c, d]]);
            }
        }
        let normals = normals::by_area(&positions, &triangles);
        largest_piece(Model { positions, triangles, normals, ..Model::default() })
    }

    /// Moves the vertices onto the surface and takes the normals from the distance function. On a coarse mesh, these
    /// normals are better than normals computed from triangles.
    pub fn settle(&self, model: &mut Model, step: f32) {
        let settled = |&start: &Vec3| {
            let active = self.near(start, 2.0 * step);
            let normal = |p| self.normal(&active, p, 0.02 * step);
            let mut p = start;
            for _ in 0..3 {
                p -= normal(p) * self.distance(&active, p).clamp(-0.25 * step, 0.25 * step);
            }
            (p, normal(p))
        };
        (model.positions, model.normals) = model.positions.par_iter().map(settled).unzip();
    }
}

/// Returns one value per vertex. Every value is less than `vertices`. All vertices of a connected piece have the same
/// value.
pub fn pieces(vertices: usize, triangles: &[[u32; 3]]) -> Vec<u32> {
    let mut parent: Vec<u32> = (0..vertices as u32).collect();
    fn root(parent: &mut [u32], mut v: u32) -> u32 {
        while parent[v as usize] != v {
            parent[v as usize] = parent[parent[v as usize] as usize];
            v = parent[v as usize];
        }
        v
    }
    for &[a, b, c] in triangles {
        for (v, w) in [(a, b), (b, c)] {
            let (v, w) = (root(&mut parent, v), root(&mut parent, w));
            parent[v as usize] = w;
        }
    }
    (0..vertices as u32).map(|v| root(&mut parent, v)).collect()
}

/// The removed pieces are cavities in the solid and small pieces beside the solid.
fn largest_piece(model: Model) -> Model {
    let pieces = pieces(model.positions.len(), &model.triangles);
    let mut sizes = vec![0u32; pieces.len()];
    pieces.iter().for_each(|&piece| sizes[piece as usize] += 1);
    let largest = (0..sizes.len()).rev().max_by_key(|&piece| sizes[piece]).unwrap_or(0) as u32;

    let mut number = vec![u32::MAX; pieces.len()];
    let mut kept = Model::default();
    for (v, _) in pieces.iter().enumerate().filter(|&(_, &piece)| piece == largest) {
        number[v] = kept.positions.len() as u32;
        kept.positions.push(model.positions[v]);
        kept.normals.push(model.normals[v]);
    }
    let stays = |t: &[u32; 3]| pieces[t[0] as usize] == largest;
    kept.triangles = model.triangles.into_iter().filter(stays).map(|t| t.map(|v| number[v as usize])).collect();
    kept
}

fn net(grid: &Grid) -> (Vec<Vec3>, Vec<[u32; 4]>) {
    let cells = grid.cells();
    let positions = cells.par_iter().map(|&cell| middle(grid, cell)).collect();
    let mut vertex_of = vec![u32::MAX; grid.values.len()];
    for (vertex, &cell) in cells.iter().enumerate() {
        vertex_of[grid.index(cell)] = vertex as u32;
    }

    let inside = |at| grid.values[grid.index(at)] < 0.0;
    let mut quads = Vec::with_capacity(cells.len());
    for &cell in &cells {
        for axis in 0..3 {
            // If the surface crosses the edge from `cell` to `next`, all four cells around this edge have vertices.
            let mut next = cell;
            next[axis] += 1;
            if inside(cell) == inside(next) {
                continue;
            }
            let [a, b, c, d] = [(1, 1), (0, 1), (0, 0), (1, 0)].map(|(du, dv)| {
                let mut other = cell;
                other[(axis + 1) % 3] -= du;
                other[(axis + 2) % 3] -= dv;
                vertex_of[grid.index(other)]
            });
            quads.push(if inside(cell) { [a, b, c, d] } else { [d, c, b, a] });
        }
    }
    (positions, quads)
}

fn middle(grid: &Grid, cell: [usize; 3]) -> Vec3 {
    let (mut sum, mut count) = (Vec3::ZERO, 0.0);
    for axis in 0..3 {
        for i in (0..8).filter(|i| i >> axis & 1 == 0) {
            let [low, high] = [i, i | 1 << axis].map(|i| corner(cell, i));
            let (a, b) = (grid.values[grid.index(low)], grid.values[grid.index(high)]);
            if (a < 0.0) != (b < 0.0) {
                sum += grid.place(low).lerp(grid.place(high), a / (a - b));
                count += 1.0;
            }
        }
    }
    sum / count
}

/// Moves every vertex in its tangent plane towards the mean of its neighbours.
fn relaxed(sdf: &Sdf, grid: &Grid, positions: &[Vec3], quads: &[[u32; 4]]) -> Vec<Vec3> {
    // On a closed surface, each neighbour of a vertex follows the vertex in exactly one quad.
    let mut around = vec![(Vec3::ZERO, Vec3::ZERO, 0.0); positions.len()];
    for quad in quads {
        let [a, b, c, d] = quad.map(|i| positions[i as usize]);
        let normal = (c - a).cross(d - b);
        for (&vertex, next) in quad.iter().zip([b, c, d, a]) {
            let (normals, neighbours, count) = &mut around[vertex as usize];
            *normals += normal;
            *neighbours += next;
            *count += 1.0;
        }
    }

    let step = grid.step;
    let moved = |(&p, &(normals, neighbours, count)): (&Vec3, &(Vec3, Vec3, f32))| {
        let n = normals.normalize_or(Vec3::Y);
        let pull = (neighbours / count - p) * 0.4;
        let slid = p + pull - n * pull.dot(n);

        // One secant step along the normal moves the vertex back towards the surface.
        let active = grid.active(p);
        let here = sdf.distance(active, slid).clamp(-step, step);
        if here == 0.0 {
            return slid;
        }
        let there = sdf.distance(active, slid - n * here);
        let slope = ((here - there) / here).clamp(0.4, 2.0);
        slid - n * (here / slope).clamp(-0.5 * step, 0.5 * step)
    };
    positions.par_iter().zip(&around).map(moved).collect()
}
