//! Pairs of one structure and one workload.

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Pair {
    pub structure: usize,
    pub workload: usize,
}

impl Pair {
    /// Sorted by structure, then by workload.
    pub fn all(structures: usize, workloads: usize) -> Vec<Self> {
        (0..structures).flat_map(|structure| (0..workloads).map(move |workload| Self { structure, workload })).collect()
    }
}
