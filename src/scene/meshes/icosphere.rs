//! The sphere made by dividing the sides of an icosahedron.

use std::collections::HashMap;

use glam::DVec3;

use super::{icosahedron, smooth};
use crate::scene::Model;

/// The [`divided_icosphere`] with edges in `2^subdivisions` parts: `20 * 4^subdivisions` triangles.
///
/// # Panics
/// Above 12 subdivisions, which exceed the triangles of a mesh.
pub fn icosphere(subdivisions: u32) -> Model {
    assert!(subdivisions <= 12, "an icosphere has at most 12 subdivisions, not {subdivisions}");
    divided_icosphere(1 << subdivisions)
}

/// A closed, smooth sphere of radius 1: `20 * steps^2` triangles, `10 * steps^2 + 2` vertices.
///
/// Each side of the icosahedron is divided into a flat, even net of `steps` steps along each edge, whose points are
/// then projected onto the sphere. The silhouette of the report's scene shows that the course's sphere was made in this
/// way. (Halving the edges and projecting after each halving gives another sphere.)
///
/// # Panics
/// If `steps` is 0 or above 4096, which exceeds the triangles of a mesh.
pub fn divided_icosphere(steps: u32) -> Model {
    assert!((1..=4096).contains(&steps), "an icosphere has 1 to 4096 steps, not {steps}");
    let mut net = Net { points: icosahedron::corners(), rows: HashMap::new(), steps };
    let triangles = icosahedron::sides().into_iter().flat_map(|side| net.divide(side)).collect();
    smooth(net.points, triangles)
}

struct Net {
    points: Vec<DVec3>,
    /// The points along an edge of the icosahedron, from the end with the lower number.
    rows: HashMap<(u32, u32), Vec<u32>>,
    steps: u32,
}

impl Net {
    /// Point numbers from `first` to `last` in `steps` even steps; the points between are projected to the sphere.
    fn row(&mut self, first: u32, last: u32, steps: u32) -> Vec<u32> {
        let (from, to) = (self.points[first as usize], self.points[last as usize]);
        let between = 1..steps.max(1);
        let numbers = (self.points.len() as u32..).take(between.len());
        let row = std::iter::once(first).chain(numbers).chain((steps > 0).then_some(last)).collect();
        self.points.extend(between.map(|i| (from + (to - from) * (f64::from(i) / f64::from(steps))).normalize()));
        row
    }

    /// The row along an edge, which two sides share.
    fn edge(&mut self, first: u32, last: u32) -> Vec<u32> {
        let key = (first.min(last), first.max(last));
        if !self.rows.contains_key(&key) {
            let row = self.row(key.0, key.1, self.steps);
            self.rows.insert(key, row);
        }
        let mut row = self.rows[&key].clone();
        if first > last {
            row.reverse();
        }
        row
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
