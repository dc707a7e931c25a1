//! The icosahedron, seen from outside and from inside.

use glam::DVec3;

use super::flat;
use crate::scene::Model;

/// Corners with the poles on the y axis, as in the course's files: a unit icosahedron, truncated to steps of 1/200,000.
///
/// The truncation affects the report's ray counts: the mirroring room of Infinitycandy is one of these.
pub(super) fn corners() -> Vec<DVec3> {
    const HEIGHT: f64 = 0.447215;
    let lower = [[0.7236, 0.52572], [-0.276385, 0.85064], [-0.894425, 0.0], [-0.276385, -0.85064], [0.7236, -0.52572]];
    let mut corners = vec![-DVec3::Y];
    corners.extend(lower.map(|[x, z]| DVec3::new(x, -HEIGHT, z)));
    corners.extend(lower.map(|[x, z]| DVec3::new(-x, HEIGHT, -z)));
    corners.push(DVec3::Y);
    corners
}

pub(super) fn sides() -> Vec<[u32; 3]> {
    let lower = |i: u32| 1 + i % 5;
    // The corner above the edge from lower corner i to the next one.
    let upper = |i: u32| 6 + (i + 3) % 5;
    (0..5)
        .flat_map(|i| {
            [
                [0, lower(i), lower(i + 1)],
                [lower(i + 1), lower(i), upper(i)],
                [lower(i + 1), upper(i), upper(i + 1)],
                [upper(i + 1), upper(i), 11],
            ]
        })
        .collect()
}

/// The icosahedron of radius 1 with poles on the y axis, flat: 20 triangles.
///
/// Each triangle has its own normal, as in the course's file. A normal computed from the placed and rounded corners
/// differs a little, and after eight mirrors a ray or two more would hit an edge.
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

/// The same, looking inward.
pub fn inside_out_icosahedron() -> Model {
    let mut model = icosahedron();
    model.triangles.iter_mut().for_each(|t| t.swap(1, 2));
    model.normals.iter_mut().for_each(|n| *n = -*n);
    model
}
