//! Unit normals at the corners of triangles.

use glam::Vec3;

use super::Model;

/// Unit normals in world space: three per smooth-shaded triangle, none per flat-shaded triangle.
#[derive(Clone, Debug, PartialEq)]
pub struct CornerNormals {
    normals: Vec<Vec3>,
    indices: Vec<[u32; 3]>,
}

impl CornerNormals {
    pub const FLAT: [u32; 3] = [Model::FLAT; 3];

    /// `indices` has three indices into `normals` per triangle. A triangle with a normal of length zero becomes
    /// flat-shaded.
    ///
    /// # Panics
    /// If an index is out of range, except in [`CornerNormals::FLAT`].
    pub fn new(normals: Vec<Vec3>, mut indices: Vec<[u32; 3]>) -> Self {
        for corners in indices.iter_mut().filter(|c| **c != Self::FLAT) {
            if corners.iter().any(|&i| normals[i as usize] == Vec3::ZERO) {
                *corners = Self::FLAT;
            }
        }
        Self { normals, indices }
    }

    #[inline]
    pub fn corners(&self, index: u32) -> Option<[Vec3; 3]> {
        let corners = self.indices[index as usize];
        (corners != Self::FLAT).then(|| corners.map(|i| self.normals[i as usize]))
    }

    pub fn parts(&self) -> (&[Vec3], &[[u32; 3]]) {
        (&self.normals, &self.indices)
    }
}
