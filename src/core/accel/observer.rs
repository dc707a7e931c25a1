//! Observing a traversal, at no cost without an observer.

/// Receives the events of a traversal. Every method does nothing by default, so that `()` compiles to nothing.
#[diagnostic::on_unimplemented(
    message = "`{Self}` cannot watch a traversal",
    label = "this is no `Observer`",
    note = "pass `&mut ()` to watch nothing, or `&mut Counts::default()` to count steps and tests"
)]
pub trait Observer {
    /// Whether the observer uses events. A structure that cannot report events on its fast path takes another path when
    /// this is true.
    const ACTIVE: bool = true;

    /// An inner node is entered.
    #[inline(always)]
    fn inner(&mut self) {}

    /// A leaf that holds `references` triangles is entered.
    #[inline(always)]
    fn leaf(&mut self, _references: u32) {}

    /// `n` triangles are tested at once: a block of several or one alone.
    #[inline(always)]
    fn test(&mut self, _n: u32) {}
}

impl Observer for () {
    const ACTIVE: bool = false;
}

/// Which events a structure reports. What is not observed is unknown, not zero.
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
    /// Triangle tests alone.
    pub const TESTS: Self = Self { steps: false, tests: true };
    /// Nothing.
    pub const NONE: Self = Self { steps: false, tests: false };
}
