//! Observers of a traversal. The observer `()` costs nothing.

/// Receives the events of a traversal. Every method does nothing by default, so `()` compiles to nothing.
#[diagnostic::on_unimplemented(
    message = "`{Self}` cannot watch a traversal",
    label = "does not implement `Observer`",
    note = "pass `&mut ()` to watch nothing, or `&mut Counts::default()` to count steps and tests"
)]
pub trait Observer {
    /// Whether the observer uses events. If so, a structure may need a slower path.
    const ACTIVE: bool = true;

    /// The traversal enters an inner node.
    #[inline(always)]
    fn inner(&mut self) {}

    /// The traversal enters a leaf with `references` triangles.
    #[inline(always)]
    fn leaf(&mut self, _references: u32) {}

    /// The traversal tests `n` triangles at once: a block, or a single triangle.
    #[inline(always)]
    fn test(&mut self, _n: u32) {}
}

impl Observer for () {
    const ACTIVE: bool = false;
}

/// The events that a structure reports. Unreported counts are unknown, not zero.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Observed {
    /// Inner nodes and leaves.
    pub steps: bool,
    /// Triangle tests.
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
