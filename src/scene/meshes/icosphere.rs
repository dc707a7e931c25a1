//! The sphere made by halving the edges of an icosahedron.

use std::collections::HashMap;

use super::{icosahedron, smooth};
use crate::scene::Model;

/// A closed, smooth sphere of radius 1: `20 * 4^subdivisions` triangles, `10 * 4^subdivisions + 2` vertices.
///
/// # Panics
/// Above 12 subdivisions, where a mesh holds no more triangles.
pub fn icosphere(subdivisions: u32) -> Model {
    assert!(subdivisions <= 12, "an icosphere has at most 12 subdivisions, not {subdivisions}");
    let mut points = icosahedron::corners();
    let mut triangles = icosahedron::sides();

    for _ in 0..subdivisions {
        let mut middles = HashMap::new();
        let mut middle = |a: u32, b: u32| {
            *middles.entry((a.min(b), a.max(b))).or_insert_with(|| {
                points.push((points[a as usize] + points[b as usize]).normalize());
                points.len() as u32 - 1
            })
        };
        triangles = triangles
            .into_iter()
            .flat_map(|[a, b, c]| {
                let (ab, bc, ca) = (middle(a, b), middle(b, c), middle(c, a));
                [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
            })
            .collect();
    }
    smooth(points.clone(), points, triangles)
}
