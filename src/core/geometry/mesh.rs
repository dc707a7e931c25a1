//! Triangle meshes.

use glam::Vec3;

use super::Aabb;

/// A set of triangles with finite coordinates and valid vertex indices.
///
/// Degenerate triangles (see [`Mesh::is_degenerate`]) keep their indices, but no ray hits them.
#[derive(Clone, Debug, PartialEq)]
pub struct Mesh {
    positions: Vec<Vec3>,
    triangles: Vec<[u32; 3]>,
    degenerate: Vec<u32>,
    bounds: Aabb,
}

/// The reason why [`Mesh::new`] rejects its input. Vertex and triangle indices start at 0.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[allow(missing_docs)] // The error messages explain the fields.
pub enum MeshError {
    /// A coordinate is infinite or NaN.
    #[error("vertex {vertex} has the coordinates ({x}, {y}, {z}): every coordinate must be a finite number")]
    NotFinite { vertex: usize, x: f32, y: f32, z: f32 },
    /// A triangle refers to a vertex that does not exist.
    #[error("triangle {triangle} refers to vertex {index}, but there are only {vertices} vertices")]
    OutOfRange { triangle: usize, index: u32, vertices: usize },
    /// There are more than 2^30 vertices or triangles.
    #[error("{count} {what} exceed the limit of {limit} per mesh: split the scene")]
    TooMany { what: &'static str, count: usize, limit: usize },
}

/// A mesh has at most this many vertices and at most this many triangles.
///
/// A triangle index and two flag bits together fit in a `u32`.
const LIMIT: usize = 1 << 30;

impl Mesh {
    /// Makes a mesh from vertices and triangles.
    ///
    /// # Errors
    /// See [`Mesh::check`].
    pub fn new(positions: Vec<Vec3>, triangles: Vec<[u32; 3]>) -> Result<Self, MeshError> {
        Self::check(&positions, &triangles)?;
        let corners = |t: &[u32; 3]| t.map(|i| positions[i as usize]);
        let bounds = Aabb::of_points(triangles.iter().flat_map(corners));
        let degenerate = (0..triangles.len() as u32).filter(|&i| collinear(corners(&triangles[i as usize]))).collect();
        Ok(Self { positions, triangles, degenerate, bounds })
    }

    /// A mesh of triangles that share no vertices.
    ///
    /// # Errors
    /// See [`Mesh::check`].
    pub fn from_triangles(triangles: &[[Vec3; 3]]) -> Result<Self, MeshError> {
        let numbers = (0..triangles.len() as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]);
        Self::new(triangles.as_flattened().to_vec(), numbers.collect())
    }

    /// Checks whether [`Mesh::new`] accepts the arrays.
    ///
    /// # Errors
    /// More than 2^30 vertices or triangles, a coordinate that is not finite, or a vertex index that is out of range.
    pub fn check(positions: &[Vec3], triangles: &[[u32; 3]]) -> Result<(), MeshError> {
        for (what, count) in [("vertices", positions.len()), ("triangles", triangles.len())] {
            if count > LIMIT {
                return Err(MeshError::TooMany { what, count, limit: LIMIT });
            }
        }
        if let Some(vertex) = positions.iter().position(|p| !p.is_finite()) {
            let Vec3 { x, y, z } = positions[vertex];
            return Err(MeshError::NotFinite { vertex, x, y, z });
        }
        for (triangle, corners) in triangles.iter().enumerate() {
            if let Some(&index) = corners.iter().find(|&&i| i as usize >= positions.len()) {
                return Err(MeshError::OutOfRange { triangle, index, vertices: positions.len() });
            }
        }
        Ok(())
    }

    /// The vertices.
    pub fn positions(&self) -> &[Vec3] {
        &self.positions
    }

    /// Three vertex indices per triangle.
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }

    /// The number of triangles, including degenerate triangles.
    pub fn len(&self) -> usize {
        self.triangles.len()
    }

    /// Whether the mesh has no triangles.
    pub fn is_empty(&self) -> bool {
        self.triangles.is_empty()
    }

    /// The corners of triangle `index`.
    #[inline]
    pub fn corners(&self, index: u32) -> [Vec3; 3] {
        self.triangles[index as usize].map(|i| self.positions[i as usize])
    }

    /// The indices of the degenerate triangles, in ascending order.
    pub fn degenerate(&self) -> &[u32] {
        &self.degenerate
    }

    /// Whether the corners of triangle `index` lie exactly on one line or at one point.
    #[inline]
    pub fn is_degenerate(&self, index: u32) -> bool {
        self.degenerate.binary_search(&index).is_ok()
    }

    /// The indices of the triangles that are not degenerate, in ascending order.
    ///
    /// A structure must contain all triangles that are not degenerate.
    pub fn solid(&self) -> impl Iterator<Item = u32> + '_ {
        let mut flat = self.degenerate.iter().copied().peekable();
        (0..self.len() as u32).filter(move |&i| flat.next_if_eq(&i).is_none())
    }

    /// The box of triangle `index`.
    #[inline]
    pub fn triangle_bounds(&self, index: u32) -> Aabb {
        Aabb::of_points(self.corners(index))
    }

    /// The box of all triangles. A mesh without triangles has an empty box.
    pub fn bounds(&self) -> Aabb {
        self.bounds
    }
}

/// Whether three points are exactly collinear.
fn collinear([a, b, c]: [Vec3; 3]) -> bool {
    if a == b || b == c || c == a {
        return true;
    }
    [(0, 1), (1, 2), (2, 0)].into_iter().all(|(i, j)| {
        // The product of two `f32` values is exact in `f64`.
        let [(ax, ay), (bx, by), (cx, cy)] = [a, b, c].map(|p| (f64::from(p[i]), f64::from(p[j])));
        sum_is_zero([ax * by, -(ay * bx), bx * cy, -(by * cx), cx * ay, -(cy * ax)])
    })
}

/// Whether the exact sum of six numbers is 0.
///
/// # References
/// Shewchuk: Adaptive precision floating-point arithmetic and fast robust geometric predicates, 1997 (Grow-Expansion).
fn sum_is_zero(terms: [f64; 6]) -> bool {
    // If the rounded sum exceeds its error bound, the exact sum is not 0.
    let size: f64 = terms.iter().map(|term| term.abs()).sum();
    if terms.iter().sum::<f64>().abs() > 8.0 * f64::EPSILON * size {
        return false;
    }

    // Write the exact sum as a sum of floats whose bits do not overlap. The exact sum is 0 only if every float is 0.
    let mut parts = [0.0; 6];
    for (count, term) in terms.into_iter().enumerate() {
        let mut rest = term;
        for part in &mut parts[..count] {
            let sum = rest + *part;
            let rounded = sum - rest;
            (*part, rest) = ((rest - (sum - rounded)) + (*part - rounded), sum);
        }
        parts[count] = rest;
    }
    parts == [0.0; 6]
}

#[cfg(test)]
mod tests {
    use rand_core::{RngCore, SeedableRng};

    use super::*;

    #[test]
    fn new_reports_the_invalid_element() {
        let points = vec![Vec3::ZERO, Vec3::X, Vec3::new(0.0, f32::NAN, 1.0)];
        let error = Mesh::new(points, vec![]).unwrap_err();
        assert!(matches!(error, MeshError::NotFinite { vertex: 2, .. }), "{error}");
        let error = Mesh::new(vec![Vec3::ZERO; 3], vec![[0, 1, 2], [0, 3, 1]]).unwrap_err();
        assert_eq!(error, MeshError::OutOfRange { triangle: 1, index: 3, vertices: 3 });
    }

    #[test]
    fn degenerate_triangles_are_counted_exactly() {
        let p = Vec3::new(0.1, 0.2, 0.3);
        let d = Vec3::new(0.5, 0.25, 0.125);
        let points = vec![p, p + d, p + d + d, Vec3::Y, Vec3::new(0.1, 0.2, 0.300_000_04)];
        let mesh = Mesh::new(points.clone(), vec![[0, 0, 3], [0, 1, 3], [3, 3, 3], [0, 4, 1]]).unwrap();
        assert_eq!(mesh.degenerate(), [0, 2]);
        assert_eq!(mesh.solid().collect::<Vec<_>>(), [1, 3]);
        let line = (0..3).map(|i| Vec3::new(1.0, 2.0, 4.0) * (i as f32 + 1.0)).collect();
        assert_eq!(Mesh::new(line, vec![[0, 1, 2]]).unwrap().degenerate(), [0]);
    }

    #[test]
    fn collinear_agrees_with_the_predicates_of_shewchuk() {
        let mut rng = rand_pcg::Pcg32::seed_from_u64(3);
        let mut found = [0; 2];
        for round in 0..30_000 {
            let digits = 1 << (round % 12);
            let mut whole = || (rng.next_u32() % (2 * digits + 1)) as f32 - digits as f32;
            let (p, d) = (Vec3::new(whole(), whole(), whole()), Vec3::new(whole(), whole(), whole()));
            let scale = 2.0_f32.powi(round % 200 - 120);
            let far = (d * whole()) * if round % 2 == 0 { 1.0 } else { 0.1 };
            let corners = [p, p + d, p + far].map(|p| p * scale);
            let straight = |i: usize, j: usize| {
                let [p, q, r] = corners.map(|p| robust::Coord { x: f64::from(p[i]), y: f64::from(p[j]) });
                robust::orient2d(p, q, r) == 0.0
            };
            let expected = straight(0, 1) && straight(1, 2) && straight(2, 0);
            assert_eq!(collinear(corners), expected, "{corners:?}");
            found[usize::from(expected)] += 1;
        }
        assert!(found.iter().all(|&count| count > 3000), "{found:?}");
    }
}
