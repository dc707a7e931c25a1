//! The memory of a finished structure.

/// Bytes of a structure, without the mesh.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Footprint {
    /// Inner nodes and leaf headers.
    pub nodes: usize,
    /// Triangle numbers in leaves, or the permutation.
    pub references: usize,
    /// Triangle data copied for the triangle test.
    pub triangles: usize,
    /// Everything else.
    pub other: usize,
}

impl Footprint {
    /// The sum of all parts.
    pub fn total(&self) -> usize {
        self.nodes + self.references + self.triangles + self.other
    }
}
