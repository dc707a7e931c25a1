//! The output of mesh generators and file loaders.

use glam::Vec3;

use super::Material;

/// Triangles with normals and materials, in model space and not yet validated.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Model {
    pub positions: Vec<Vec3>,
    pub triangles: Vec<[u32; 3]>,
    /// Corner normals, of any length; empty if the model is flat-shaded.
    pub normals: Vec<Vec3>,
    /// Three normal indices per triangle, or empty if there are no normals. In a partly smooth model, a triangle
    /// without normals has [`Model::FLAT`] three times.
    pub normal_indices: Vec<[u32; 3]>,
    /// The model's materials; a scene may replace them by name.
    pub materials: Vec<Material>,
    /// One index into `materials` per triangle, or empty if all triangles have the first material.
    pub material_of: Vec<u32>,
    /// Sentences about parts of a file that were left out or replaced.
    pub notes: Vec<String>,
}

impl Model {
    /// The normal index of a triangle without normals.
    pub const FLAT: u32 = u32::MAX;

    /// The indices of a placed triangle. A placement that mirrors reverses their order, which keeps the front side.
    pub fn placed([a, b, c]: [u32; 3], is_mirrored: bool) -> [u32; 3] {
        if is_mirrored { [a, c, b] } else { [a, b, c] }
    }
}
