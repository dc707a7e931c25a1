//! Counts that are the same on every machine (Havran, Purgathofer 2003).

use std::ops::AddAssign;

use super::Observer;

/// Sums over the observed rays.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// Inner nodes entered.
    pub inner: u64,
    /// Leaves entered, including empty ones.
    pub leaves: u64,
    /// Empty leaves entered.
    pub empty_leaves: u64,
    /// Triangles tested.
    pub tests: u64,
    /// Blocks of triangles tested at once; equal to `tests` if triangles are tested one by one.
    pub blocks: u64,
}

impl Counts {
    /// Traversal steps: all nodes entered.
    pub fn steps(&self) -> u64 {
        self.inner + self.leaves
    }
}

impl Observer for Counts {
    #[inline(always)]
    fn inner(&mut self) {
        self.inner += 1;
    }

    #[inline(always)]
    fn leaf(&mut self, references: u32) {
        self.leaves += 1;
        self.empty_leaves += u64::from(references == 0);
    }

    #[inline(always)]
    fn test(&mut self, n: u32) {
        self.tests += u64::from(n);
        self.blocks += 1;
    }
}

impl AddAssign for Counts {
    fn add_assign(&mut self, other: Self) {
        self.inner += other.inner;
        self.leaves += other.leaves;
        self.empty_leaves += other.empty_leaves;
        self.tests += other.tests;
        self.blocks += other.blocks;
    }
}
