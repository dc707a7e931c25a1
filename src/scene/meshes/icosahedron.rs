//! The icosahedron, seen from outside and from inside.

use glam::{DVec3, Vec3};

use super::{flat, on_circle};
use crate::scene::Model;

/// Corners at distance 1, the first and the last on the y axis; the upper ring has one on the x axis.
pub(super) fn corners() -> Vec<DVec3> {
    // Both rings lie 1 / sqrt 5 from the middle and have the radius 2 / sqrt 5.
    let height = 1.0 / 5.0f64.sqrt();
    let ring = |y: f64, first: u32| {
        (0..5).map(move |i| {
            let (cosine, sine) = on_circle(2 * i + first, 10);
            DVec3::new(2.0 * height * cosine, y, -2.0 * height * sine)
        })
    };
    let mut corners = vec![-DVec3::Y];
    corners.extend(ring(-height, 1));
    corners.extend(ring(height, 0));
    corners.push(DVec3::Y);
    corners
}

/// The twenty sides, looking outward.
pub(super) fn sides() -> Vec<[u32; 3]> {
    let lower = |i: u32| 1 + i % 5;
    let upper = |i: u32| 6 + i % 5;
    (0..5)
        .flat_map(|i| {
            [
                [0, lower(i + 1), lower(i)],
                [lower(i), lower(i + 1), upper(i + 1)],
                [upper(i), lower(i), upper(i + 1)],
                [11, upper(i), upper(i + 1)],
            ]
        })
        .collect()
}

/// The icosahedron of radius 1 with poles on the y axis, flat: 20 triangles.
pub fn icosahedron() -> Model {
    flat(corners().into_iter().map(|c| c.as_vec3()).collect::<Vec<Vec3>>(), sides())
}

/// The same, looking inward.
pub fn inside_out_icosahedron() -> Model {
    let mut model = icosahedron();
    model.triangles.iter_mut().for_each(|t| t.swap(1, 2));
    model
}
