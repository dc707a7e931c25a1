//! The memory of a finished structure.

/// Bytes of a structure, without the mesh.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Footprint {
    /// Inner nodes and leaf headers.
    pub nodes: usize,
    /// Triangle indices of the leaves.
    pub references: usize,
    /// Copies of triangle data for the triangle test.
    pub triangles: usize,
    /// All other data.
    pub other: usize,
}

impl Footprint {
    /// The sum of all fields.
    pub fn total(&self) -> usize {
        self.nodes + self.references + self.triangles + self.other
    }
}
