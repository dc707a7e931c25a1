//! Structures of others may panic on a ray as on a mesh: one of them must not end a run over many.

use std::cell::Cell;
use std::panic::{self, AssertUnwindSafe};
use std::rc::Rc;

use crate::measure::{Pass, Timed};

/// A structure that takes no part, and why.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Refused {
    /// As chosen.
    pub label: String,
    /// The scene that it takes no part in.
    pub scene: String,
    /// A sentence.
    pub reason: String,
}

/// Said of a structure whose traversal panicked.
pub const PANICKED: &str =
    "its traversal panicked on these rays: leave the structure out, or find the ray with `sahara validate`";

/// The result of asking a structure, or nothing if it panicked.
pub fn guarded<R>(ask: impl FnOnce() -> R) -> Option<R> {
    panic::catch_unwind(AssertUnwindSafe(ask)).ok()
}

/// A pass that survives a panic of its structure: from then on it does nothing and says so.
pub(super) struct Guarded<'a> {
    pass: Pass<'a>,
    panicked: Rc<Cell<bool>>,
}

impl<'a> Guarded<'a> {
    /// The pass, and whether it has panicked.
    pub fn new(pass: Pass<'a>) -> (Self, Rc<Cell<bool>>) {
        let panicked = Rc::default();
        (Self { pass, panicked: Rc::clone(&panicked) }, panicked)
    }
}

impl Timed for Guarded<'_> {
    fn rays(&self) -> usize {
        self.pass.rays()
    }

    fn restrict(&mut self, rays: usize) {
        self.pass.restrict(rays);
    }

    fn clear(&mut self) {
        if !self.panicked.get() && guarded(|| self.pass.clear()).is_none() {
            self.panicked.set(true);
        }
    }

    fn run(&mut self) {
        if !self.panicked.get() && guarded(|| self.pass.run()).is_none() {
            self.panicked.set(true);
        }
    }

    fn checksum(&self) -> u64 {
        if self.panicked.get() { 0 } else { self.pass.checksum() }
    }
}
