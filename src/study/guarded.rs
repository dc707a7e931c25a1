//! Structures of others may panic on a ray as on a mesh: one of them must not end a run over many.

use std::cell::Cell;
use std::panic::{self, AssertUnwindSafe};
use std::rc::Rc;

use serde::{Deserialize, Serialize};

use super::Trouble;
use crate::measure::{Pass, Stopwatch, Timed};

/// A structure that takes no part, and why.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Refused {
    /// As chosen.
    pub label: String,
    /// The scene that it takes no part in.
    pub scene: String,
    /// A sentence.
    pub reason: String,
}

impl Refused {
    /// As a trouble that a table tells.
    pub fn trouble(&self) -> Trouble {
        Trouble { structure: self.label.clone(), sentence: String::new(), refused: true, wrong: false }
    }
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
    levels: usize,
    panicked: Rc<Cell<bool>>,
}

impl<'a> Guarded<'a> {
    /// The pass, and whether it has panicked.
    pub fn new(pass: Pass<'a>) -> (Self, Rc<Cell<bool>>) {
        let panicked = Rc::default();
        (Self { pass, levels: 1, panicked: Rc::clone(&panicked) }, panicked)
    }
}

impl Timed for Guarded<'_> {
    fn rays(&self) -> usize {
        self.pass.rays()
    }

    fn choose(&mut self, levels: &[usize], epoch: usize) {
        self.levels = levels.len();
        if !self.panicked.get() && guarded(|| self.pass.choose(levels, epoch)).is_none() {
            self.panicked.set(true);
        }
    }

    fn clear(&mut self) {
        self.pass.clear();
    }

    fn lead_in(&mut self) {
        if !self.panicked.get() && guarded(|| self.pass.lead_in()).is_none() {
            self.panicked.set(true);
        }
    }

    fn run(&mut self, watch: &Stopwatch) -> Vec<u64> {
        let ns = if self.panicked.get() { None } else { guarded(|| self.pass.run(watch)) };
        self.panicked.set(ns.is_none());
        ns.unwrap_or_else(|| vec![0; self.levels])
    }

    fn checksum(&self) -> u64 {
        if self.panicked.get() { 0 } else { self.pass.checksum() }
    }

    fn contradicts_itself(&self) -> bool {
        !self.panicked.get() && self.pass.contradicts_itself()
    }
}
