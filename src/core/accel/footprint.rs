//! The memory of a finished structure.

/// Bytes of a structure, without the mesh.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Footprint {
    /// Inner nodes and leaf headers.
    pub nodes: usize,
    /// Triangle indices that leaves store, or the permutation of triangle indices that leaves refer to.
    pub references: usize,
    /// Triangle data copied for the triangle test.
    pub triangles: usize,
    /// Everything else.
    pub other: usize,
}

impl Footprint {
    /// The sum of all fields.
    pub fn total(&self) -> usize {
        self.nodes + self.references + self.triangles + self.other
    }
}
