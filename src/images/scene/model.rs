//! The output of mesh generators and file loaders.

use std::collections::TryReserveError;

use glam::Vec3;

use super::Material;

/// Unvalidated triangles with normals and materials, in model space.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Model {
    pub positions: Vec<Vec3>,
    pub triangles: Vec<[u32; 3]>,
    /// Corner normals, not necessarily of unit length. Empty if the model is flat-shaded.
    pub normals: Vec<Vec3>,
    /// Three indices into `normals` per triangle. May be empty if all triangles are flat-shaded. All three indices
    /// of a flat-shaded triangle are [`Model::FLAT`].
    pub normal_indices: Vec<[u32; 3]>,
    pub materials: Vec<Material>,
    /// One index into `materials` per triangle. May be empty if all triangles have the first material.
    pub material_of: Vec<u32>,
    /// One sentence for each ignored or replaced feature of the file.
    pub notes: Vec<String>,
}

impl Model {
    pub const FLAT: u32 = u32::MAX;

    /// Reverses the vertices of a mirrored triangle to keep its front side.
    pub fn placed([a, b, c]: [u32; 3], is_mirrored: bool) -> [u32; 3] {
        if is_mirrored { [a, c, b] } else { [a, b, c] }
    }

    pub(super) fn try_reserve(
        &mut self,
        vertices: usize,
        normals: usize,
        triangles: usize,
    ) -> Result<(), TryReserveError> {
        self.positions.try_reserve_exact(vertices)?;
        self.normals.try_reserve_exact(normals)?;
        self.triangles.try_reserve_exact(triangles)?;
        self.normal_indices.try_reserve_exact(triangles)?;
        self.material_of.try_reserve_exact(triangles)
    }

    /// Makes a triangle flat-shaded if a normal of the triangle is missing or cannot be normalized.
    pub(super) fn flatten_invalid_normals(&mut self) {
        let Self { normals, normal_indices, notes, .. } = self;
        let is_valid = |&n: &u32| {
            n == Self::FLAT || normals.get(n as usize).is_some_and(|n| n.is_finite() && n.length_squared() > 0.0)
        };
        let mut flattened = 0;
        for corners in normal_indices.iter_mut().filter(|corners| !corners.iter().all(is_valid)) {
            *corners = [Self::FLAT; 3];
            flattened += 1;
        }
        if flattened > 0 {
            notes.push(format!("{flattened} triangles have an invalid normal: shaded flat"));
        }
    }
}
