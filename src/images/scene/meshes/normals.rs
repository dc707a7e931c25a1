//! Vertex normals.

use glam::{DVec3, Vec3};

/// The program that wrote the mesh files of the source report stored normals as 16-bit integers.
const STEPS: f64 = 32767.0;

/// Each vertex normal is the angle-weighted mean of triangle normals.
///
/// The coordinates of each normal are truncated to multiples of 1/32767, then rounded to six decimals. The mesh files
/// of the source report contain normals with this rounding. With unrounded normals, ray counts differ from the source
/// report by up to 140.
pub(super) fn by_angle_quantised(points: &[DVec3], triangles: &[[u32; 3]]) -> Vec<Vec3> {
    let mut sums = vec![DVec3::ZERO; points.len()];
    for triangle in triangles {
        let [a, b, c] = triangle.map(|i| points[i as usize]);
        let Some(normal) = (b - a).cross(c - a).try_normalize() else { continue };
        for (i, [p, q, r]) in [[a, b, c], [b, c, a], [c, a, b]].into_iter().enumerate() {
            let cosine = (q - p).normalize().dot((r - p).normalize());
            sums[triangle[i] as usize] += normal * libm::acos(cosine.clamp(-1.0, 1.0));
        }
    }
    let written = |sum: DVec3| {
        let normal = sum.try_normalize().expect("every vertex has a triangle with an area");
        (((normal * STEPS).trunc() / STEPS * 1e6).round() / 1e6).as_vec3()
    };
    sums.into_iter().map(written).collect()
}

pub(super) fn by_area(positions: &[Vec3], triangles: &[[u32; 3]]) -> Vec<Vec3> {
    let mut normals = vec![Vec3::ZERO; positions.len()];
    for triangle in triangles {
        let [a, b, c] = triangle.map(|i| positions[i as usize]);
        let normal = (b - a).cross(c - a);
        triangle.iter().for_each(|&v| normals[v as usize] += normal);
    }
    normals.into_iter().map(|n| n.normalize_or(Vec3::Y)).collect()
}
