//! The unit of timing: a structure on a workload.

/// A structure and a workload, by index.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Pair {
    pub structure: usize,
    pub workload: usize,
}

impl Pair {
    /// Every structure on every workload, structure by structure.
    pub fn all(structures: usize, workloads: usize) -> Vec<Self> {
        (0..structures).flat_map(|structure| (0..workloads).map(move |workload| Self { structure, workload })).collect()
    }
}
