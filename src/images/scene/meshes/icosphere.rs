//! Icosahedra and icospheres.

use std::collections::HashMap;

use glam::DVec3;

use super::{flat, smooth};
use crate::scene::Model;

/// The coordinates are multiples of 1/200,000, as in the mesh files of the source report. The ray counts of the source
/// report depend on these inexact values: in the scene Infinitycandy, an icosahedron of mirrors encloses all other
/// objects. The source report is a student report that this project reproduces.
fn corners() -> Vec<DVec3> {
    const HEIGHT: f64 = 0.447215;
    let lower = [[0.7236, 0.52572], [-0.276385, 0.85064], [-0.894425, 0.0], [-0.276385, -0.85064], [0.7236, -0.52572]];
    let mut corners = vec![-DVec3::Y];
    corners.extend(lower.map(|[x, z]| DVec3::new(x, -HEIGHT, z)));
    corners.extend(lower.map(|[x, z]| DVec3::new(-x, HEIGHT, -z)));
    corners.push(DVec3::Y);
    corners
}

fn sides() -> Vec<[u32; 3]> {
    let lower = |i: u32| 1 + i % 5;
    // The upper corner above the edge from lower corner i to lower corner i + 1.
    let upper = |i: u32| 6 + (i + 3) % 5;
    let gore = |i: u32| {
        let [a, b, c, d] = [lower(i), lower(i + 1), upper(i), upper(i + 1)];
        [[0, a, b], [b, a, c], [b, c, d], [d, c, 11]]
    };
    (0..5).flat_map(gore).collect()
}

/// An outward-facing icosahedron of radius 1 with poles on the y axis.
///
/// The stored normals are needed to reproduce the ray counts of the source report. Normals computed in world space from
/// rounded corners would differ slightly.
pub fn icosahedron() -> Model {
    let points = corners();
    let normal = |triangle: &[u32; 3]| {
        let [a, b, c] = triangle.map(|i| points[i as usize]);
        (b - a).cross(c - a).normalize().as_vec3()
    };
    let triangles = sides();
    Model {
        normals: triangles.iter().map(normal).collect(),
        normal_indices: (0..triangles.len() as u32).map(|i| [i; 3]).collect(),
        ..flat(points.iter().map(|c| c.as_vec3()).collect(), triangles)
    }
}

pub fn inside_out_icosahedron() -> Model {
    let mut model = icosahedron();
    model.triangles.iter_mut().for_each(|t| t.swap(1, 2));
    model.normals.iter_mut().for_each(|n| *n = -*n);
    model
}

/// A smooth sphere of radius 1 with `20 * steps^2` triangles and `10 * steps^2 + 2` vertices.
///
/// Repeated halving of edges would not reproduce the silhouette of the sphere in the source report.
///
/// # Panics
/// If `steps` is 0 or above 4096.
pub fn icosphere(steps: u32) -> Model {
    assert!((1..=4096).contains(&steps), "an icosphere has 1 to 4096 steps, not {steps}");
    let mut net = Net { points: corners(), rows: HashMap::new(), steps };
    let triangles = sides().into_iter().flat_map(|side| net.divide(side)).collect();
    smooth(net.points, triangles)
}

struct Net {
    points: Vec<DVec3>,
    /// Point numbers along each edge of the icosahedron, from the end with the smaller number.
    rows: HashMap<(u32, u32), Vec<u32>>,
    steps: u32,
}

impl Net {
    /// Returns the whole row, including the ends.
    fn row(&mut self, first: u32, last: u32, steps: u32) -> Vec<u32> {
        let (from, to) = (self.points[first as usize], self.points[last as usize]);
        let between = 1..steps.max(1);
        let numbers = (self.points.len() as u32..).take(between.len());
        let row = std::iter::once(first).chain(numbers).chain((steps > 0).then_some(last)).collect();
        self.points.extend(between.map(|i| (from + (to - from) * (f64::from(i) / f64::from(steps))).normalize()));
        row
    }

    fn edge(&mut self, first: u32, last: u32) -> Vec<u32> {
        let key = (first.min(last), first.max(last));
        if !self.rows.contains_key(&key) {
            let row = self.row(key.0, key.1, self.steps);
            self.rows.insert(key, row);
        }
        let row = self.rows[&key].iter().copied();
        if first < last { row.collect() } else { row.rev().collect() }
    }

    fn divide(&mut self, [a, b, c]: [u32; 3]) -> Vec<[u32; 3]> {
        let (ab, ac, bc) = (self.edge(a, b), self.edge(a, c), self.edge(b, c));
        let mut triangles = Vec::new();
        let mut above = vec![a];
        for step in 1..=self.steps {
            let i = step as usize;
            let below = if step == self.steps { bc.clone() } else { self.row(ab[i], ac[i], step) };
            triangles.extend((0..i).map(|k| [above[k], below[k], below[k + 1]]));
            triangles.extend((1..i).map(|k| [above[k - 1], below[k], above[k]]));
            above = below;
        }
        triangles
    }
}
