//! How much memory a finished structure takes.

/// Bytes of a structure, without the mesh it was built from.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Footprint {
    /// Inner nodes and leaf headers.
    pub nodes: usize,
    /// Triangle numbers kept in leaves, or the permutation.
    pub references: usize,
    /// Triangle data copied for the triangle test.
    pub triangles: usize,
    /// Everything else.
    pub other: usize,
}

impl Footprint {
    /// All bytes together.
    pub fn total(&self) -> usize {
        self.nodes + self.references + self.triangles + self.other
    }
}
