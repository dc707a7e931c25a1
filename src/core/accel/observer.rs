//! Observers of a traversal.

/// Receives the events of a traversal. The observer `()` compiles to nothing.
#[diagnostic::on_unimplemented(
    message = "`{Self}` is not an observer of a traversal",
    label = "does not implement `Observer`",
    note = "pass `&mut ()` to observe nothing, or `&mut Counts::default()` to count steps and tests"
)]
pub trait Observer {
    /// Whether the observer uses the events. If `false`, a structure may omit all events.
    const ACTIVE: bool = true;

    /// The traversal enters an inner node.
    #[inline(always)]
    fn inner(&mut self) {}

    /// The traversal enters a leaf with `references` triangles.
    #[inline(always)]
    fn leaf(&mut self, _references: u32) {}

    /// The traversal tests `n` triangles at once.
    #[inline(always)]
    fn test(&mut self, _n: u32) {}
}

impl Observer for () {
    const ACTIVE: bool = false;
}

/// The events that a structure reports. Unreported counts are unknown, not zero.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Observed {
    /// Whether the structure reports inner nodes and leaves.
    pub steps: bool,
    /// Whether the structure reports triangle tests.
    pub tests: bool,
}

impl Observed {
    /// Steps and tests.
    pub const ALL: Self = Self { steps: true, tests: true };
    /// Triangle tests only.
    pub const TESTS: Self = Self { steps: false, tests: true };
    /// No events.
    pub const NONE: Self = Self { steps: false, tests: false };
}

/// Counts of traversal events, summed over the observed rays (Havran, Purgathofer 2003).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// Inner nodes entered.
    pub inner: u64,
    /// Leaves entered, including empty leaves.
    pub leaves: u64,
    /// Empty leaves entered.
    pub empty_leaves: u64,
    /// Triangles tested.
    pub tests: u64,
    /// Blocks tested. The triangles of a block are tested at once.
    pub blocks: u64,
}

impl Counts {
    /// All nodes entered.
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
