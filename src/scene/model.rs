//! What mesh generators and file loaders hand over.

use glam::Vec3;

use super::Material;

/// Triangles with what shading needs of them, in model space and not yet validated.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Model {
    pub positions: Vec<Vec3>,
    pub triangles: Vec<[u32; 3]>,
    /// Corner normals, of any length; empty when the model is flat-shaded.
    pub normals: Vec<Vec3>,
    /// Three normal numbers a triangle, or empty when there are no normals. A triangle of a partly smooth model that
    /// has no normals of its own holds [`Model::FLAT`] three times.
    pub normal_indices: Vec<[u32; 3]>,
    /// Materials that the model itself names; a scene may replace them by name.
    pub materials: Vec<Material>,
    /// One number into `materials` a triangle, or empty when all triangles have the first.
    pub material_of: Vec<u32>,
    /// What was left out of a file or replaced when the model was made, a sentence each.
    pub notes: Vec<String>,
}

impl Model {
    /// The normal number of a triangle that has no normals.
    pub const FLAT: u32 = u32::MAX;

    /// The corners of a triangle, or their normals, where it is placed: a mirror turns them round, so that the front stays in
    /// front.
    pub fn placed([a, b, c]: [u32; 3], is_mirrored: bool) -> [u32; 3] {
        if is_mirrored { [a, c, b] } else { [a, b, c] }
    }
}
