//! The Utah teapot, as in the source report, a student report that this project reproduces.

use std::collections::HashMap;

use glam::{DVec3, Vec3};

use super::{catmull_clark, fit::map_box, halves, smooth};
use crate::geometry::Aabb;
use crate::scene::Model;

const PATCHES: &str = include_str!("teapot_patches.txt");

pub(super) const BOUNDS: Aabb =
    Aabb { min: Vec3::new(-23.096241, -9.328575, -15.123246), max: Vec3::new(26.321558, 15.076026, 15.098365) };

const STEPS: usize = 4;

/// The smooth-shaded teapot, with y up and the spout towards +x.
///
/// The construction reproduces the mesh file of the source report to the last digit in the file. Each quadrilateral is
/// cut along the longer diagonal, as in this file.
pub fn teapot() -> Model {
    let (points, faces) = welded_patches();
    let (points, quads) = catmull_clark::subdivide(&points, &faces);
    let points = into_bounds(&points);
    let triangles = quads.into_iter().flat_map(|quad| along_longer_diagonal(&points, quad)).collect();
    smooth(points, triangles)
}

/// Index, published x and used x of one control point. The mesh of the source report swaps two digits of x.
const PUBLISHED: (usize, f64, f64) = (16, -0.784, -0.874);

/// Each patch contains sixteen point numbers, counted from 1.
fn published() -> (Vec<[usize; 16]>, Vec<DVec3>) {
    let (mut patches, mut points) = (Vec::new(), Vec::new());
    for line in PATCHES.lines().filter(|l| !l.starts_with(['#', 'p'])) {
        let numbers: Vec<f64> = line.split(' ').map(|n| n.parse().expect("the data file holds numbers")).collect();
        match numbers[..] {
            [x, y, z] => points.push(DVec3::new(x, y, z)),
            _ => patches.push(std::array::from_fn(|i| numbers[i] as usize)),
        }
    }
    (patches, points)
}

/// If one side of a patch is a single point, the faces at this point are triangles.
fn welded_patches() -> (Vec<DVec3>, Vec<Vec<u32>>) {
    let (patches, mut controls) = published();
    let (number, published, used) = PUBLISHED;
    assert_eq!(controls[number].x, published, "the data file holds the published point");
    controls[number].x = used;

    let mut points = Vec::new();
    let mut known = HashMap::new();
    let mut faces = Vec::new();
    for (number, patch) in patches.iter().enumerate() {
        let mut vertices = Vec::new();
        for row in 0..=STEPS {
            for column in 0..=STEPS {
                let p = evaluate(&patch.map(|i| controls[i - 1]), row, column);
                // Neighbouring patches compute shared points with different rounding errors.
                let key = (shell(number), (p * 1e6).round().as_i64vec3());
                let vertex = *known.entry(key).or_insert(points.len() as u32);
                if vertex as usize == points.len() {
                    points.push(p);
                }
                vertices.push(vertex);
            }
        }
        for corner in (0..STEPS * STEPS).map(|cell| cell / STEPS * (STEPS + 1) + cell % STEPS) {
            let mut face: Vec<u32> = [0, 1, STEPS + 2, STEPS + 1].map(|step| vertices[corner + step]).to_vec();
            face.dedup();
            faces.push(face);
        }
    }
    (points, faces)
}

/// Patches are numbered from 0. The shells 0 to 3 are body, handle, spout and lid.
fn shell(patch: usize) -> usize {
    match patch {
        0..12 | 28.. => 0,
        12..16 => 1,
        16..20 => 2,
        20..28 => 3,
    }
}

fn evaluate(controls: &[DVec3; 16], row: usize, column: usize) -> DVec3 {
    let weights = |step: usize| {
        let t = step as f64 / STEPS as f64;
        let s = 1.0 - t;
        [s * s * s, 3.0 * s * s * t, 3.0 * s * t * t, t * t * t]
    };
    let (down, across) = (weights(row), weights(column));
    (0..16).map(|i| controls[i] * (down[i / 4] * across[i % 4])).sum()
}

fn into_bounds(points: &[DVec3]) -> Vec<DVec3> {
    let turned: Vec<DVec3> = points.iter().map(|p| DVec3::new(p.x, p.z, -p.y)).collect();
    let low = turned.iter().copied().fold(DVec3::INFINITY, DVec3::min);
    let high = turned.iter().copied().fold(DVec3::NEG_INFINITY, DVec3::max);
    turned.into_iter().map(|p| map_box(p, [low, high], BOUNDS)).collect()
}

fn along_longer_diagonal(points: &[DVec3], [a, b, c, d]: [u32; 4]) -> [[u32; 3]; 2] {
    let squared = |i: u32, j: u32| points[i as usize].distance_squared(points[j as usize]);
    halves(if squared(a, c) > squared(b, d) { [a, b, c, d] } else { [b, c, d, a] })
}

#[cfg(test)]
mod tests {
    use std::collections::HashSet;
    use std::path::Path;

    use super::*;

    #[test]
    fn no_diagonal_depends_on_rounding() {
        let (points, faces) = welded_patches();
        let (points, quads) = catmull_clark::subdivide(&points, &faces);
        assert_eq!((faces.len(), quads.len()), (512, 2016));
        let points = into_bounds(&points);
        for [a, b, c, d] in quads {
            let squared = |i: u32, j: u32| points[i as usize].distance_squared(points[j as usize]);
            let (one, other) = (squared(a, c), squared(b, d));
            assert!((one - other).abs() > 1e-9 * one, "diagonals {one} and {other}");
        }
    }

    /// We are not permitted to distribute the mesh file. Without the file, the test is skipped.
    #[test]
    fn vertices_triangles_and_normals_are_those_of_the_report() {
        let folder = std::env::var_os("SAHARA_DATA").unwrap_or_default();
        let path = Path::new(&folder).join("teapot_4032.obj");
        if !path.is_file() {
            eprintln!("skipped: there is no {}", path.display());
            return;
        }
        let (ours, theirs) = (teapot(), crate::scene::load(&path).unwrap());

        let gap = |p: &Vec3, i: u32| p.distance(theirs.positions[i as usize]);
        let all = || 0..theirs.positions.len() as u32;
        let nearest_of = |p: &Vec3| all().min_by(|&i, &j| gap(p, i).total_cmp(&gap(p, j))).unwrap();
        let nearest: Vec<u32> = ours.positions.iter().map(nearest_of).collect();
        let worst = ours.positions.iter().zip(&nearest).map(|(p, &i)| gap(p, i)).fold(0.0, f32::max);
        assert!(worst < 1e-5, "a vertex is {worst} off");
        assert_eq!(nearest.iter().copied().collect::<HashSet<u32>>(), all().collect());

        let from_least = |[a, b, c]: [u32; 3]| [[a, b, c], [b, c, a], [c, a, b]].into_iter().min();
        let matched: HashSet<_> = ours.triangles.iter().map(|t| from_least(t.map(|i| nearest[i as usize]))).collect();
        assert_eq!(matched, theirs.triangles.iter().map(|&t| from_least(t)).collect());

        let mut normal_of = vec![Vec3::ZERO; theirs.positions.len()];
        for (corners, normals) in theirs.triangles.iter().zip(&theirs.normal_indices) {
            (0..3).for_each(|i| normal_of[corners[i] as usize] = theirs.normals[normals[i] as usize]);
        }
        let turned = |(i, n): (usize, &Vec3)| n.distance(normal_of[nearest[i] as usize]);
        let worst = ours.normals.iter().enumerate().map(turned).fold(0.0, f32::max);
        assert!(worst < 1e-4, "a normal is {worst} off");
    }
}
