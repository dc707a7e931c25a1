//! The mesh every structure is built over.

use glam::{DVec2, Vec3};

use super::Aabb;

/// A validated set of triangles: every coordinate is finite, every index exists.
///
/// Degenerate triangles (see [`Mesh::is_degenerate`]) stay in it, so that numbers do not shift, but nothing can hit them.
#[derive(Clone, Debug, PartialEq)]
pub struct Mesh {
    positions: Vec<Vec3>,
    triangles: Vec<[u32; 3]>,
    degenerate: Vec<u32>,
    bounds: Aabb,
}

/// Why [`Mesh::new`] refuses its input. Numbers count from 0.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum MeshError {
    #[error("vertex {vertex} has the coordinates ({x}, {y}, {z}): every coordinate must be a finite number")]
    NotFinite { vertex: usize, x: f32, y: f32, z: f32 },
    #[error("triangle {triangle} names vertex {index}, but there are only {vertices} vertices")]
    OutOfRange { triangle: usize, index: u32, vertices: usize },
    #[error("{count} {what} are more than the {limit} a mesh can hold: split the scene")]
    TooMany { what: &'static str, count: usize, limit: usize },
}

/// At most this many triangles or vertices, so that a triangle number and two flag bits fit a `u32`.
const LIMIT: usize = 1 << 30;

impl Mesh {
    /// The door: what passes needs no further check.
    ///
    /// # Errors
    /// As [`Mesh::check`].
    pub fn new(positions: Vec<Vec3>, triangles: Vec<[u32; 3]>) -> Result<Self, MeshError> {
        Self::check(&positions, &triangles)?;
        let corners = |t: &[u32; 3]| t.map(|i| positions[i as usize]);
        let bounds = Aabb::of_points(triangles.iter().flat_map(corners));
        let degenerate = (0..triangles.len() as u32).filter(|&i| collinear(corners(&triangles[i as usize]))).collect();
        Ok(Self { positions, triangles, degenerate, bounds })
    }

    /// Whether [`Mesh::new`] would take these arrays.
    ///
    /// # Errors
    /// The first vertex that is not finite, the first index out of range, or more than 2^30 elements.
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

    pub fn positions(&self) -> &[Vec3] {
        &self.positions
    }

    /// Three vertex numbers a triangle.
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }

    /// Number of triangles, degenerate ones included.
    pub fn len(&self) -> usize {
        self.triangles.len()
    }

    pub fn is_empty(&self) -> bool {
        self.triangles.is_empty()
    }

    /// The corners of triangle `index`.
    #[inline]
    pub fn corners(&self, index: u32) -> [Vec3; 3] {
        self.triangles[index as usize].map(|i| self.positions[i as usize])
    }

    /// Numbers of the triangles without area, ascending.
    pub fn degenerate(&self) -> &[u32] {
        &self.degenerate
    }

    /// Whether the corners of triangle `index` lie on one line or in one point, decided exactly.
    #[inline]
    pub fn is_degenerate(&self, index: u32) -> bool {
        self.degenerate.binary_search(&index).is_ok()
    }

    /// Numbers of the triangles that have an area, ascending: all that a structure needs to hold.
    pub fn solid(&self) -> impl Iterator<Item = u32> + '_ {
        let mut flat = self.degenerate.iter().copied().peekable();
        (0..self.len() as u32).filter(move |&i| flat.next_if_eq(&i).is_none())
    }

    /// The box of triangle `index`.
    #[inline]
    pub fn triangle_bounds(&self, index: u32) -> Aabb {
        Aabb::of_points(self.corners(index))
    }

    /// The box of all triangles; empty when there are none.
    pub fn bounds(&self) -> Aabb {
        self.bounds
    }

    /// Bytes of the vertex and index arrays.
    pub fn bytes(&self) -> usize {
        size_of_val(&self.positions[..]) + size_of_val(&self.triangles[..])
    }
}

/// Exact: three points are collinear in space if they are in all three coordinate planes (Shewchuk 1997 predicates).
fn collinear([a, b, c]: [Vec3; 3]) -> bool {
    if a == b || b == c || c == a {
        return true;
    }
    [(0, 1), (1, 2), (2, 0)].into_iter().all(|(i, j)| {
        let [p, q, r] = [a, b, c].map(|v| {
            let p = DVec2::new(v[i].into(), v[j].into());
            robust::Coord { x: p.x, y: p.y }
        });
        robust::orient2d(p, q, r) == 0.0
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_door_names_what_it_refuses() {
        let points = vec![Vec3::ZERO, Vec3::X, Vec3::new(0.0, f32::NAN, 1.0)];
        let error = Mesh::new(points, vec![]).unwrap_err();
        assert!(matches!(error, MeshError::NotFinite { vertex: 2, .. }), "{error}");
        let error = Mesh::new(vec![Vec3::ZERO; 3], vec![[0, 1, 2], [0, 3, 1]]).unwrap_err();
        assert_eq!(error, MeshError::OutOfRange { triangle: 1, index: 3, vertices: 3 });
    }

    #[test]
    fn degenerate_triangles_are_counted_exactly() {
        // The corners p, p + d, p + 2d are collinear although the f32 cross product of their edges is not zero.
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
    fn an_empty_mesh_has_empty_bounds() {
        let mesh = Mesh::new(vec![], vec![]).unwrap();
        assert!(mesh.is_empty() && mesh.bounds().is_empty());
    }
}
