//! Catches panics of structures. A panic on one ray must not end the run.

use std::rc::Rc;

use crate::measure::{Failure, Pass, Stopwatch, Timed};
use crate::panics::caught;

pub const PANICKED: &str =
    "its traversal panicked on these rays: omit the structure, or find the ray with `sahara validate`";

pub fn guarded<R>(query: impl FnOnce() -> R) -> Option<R> {
    caught(query).ok()
}

/// Catches panics of `pass`. After a panic, `pass` traces no rays.
pub struct Guarded<'a> {
    pass: Pass<'a>,
    levels: usize,
    failure: Failure,
}

impl<'a> Guarded<'a> {
    /// If `pass` panics, the returned `Failure` receives the reason.
    pub fn new(pass: Pass<'a>) -> (Self, Failure) {
        let failure = Failure::default();
        (Self { pass, levels: 1, failure: Rc::clone(&failure) }, failure)
    }

    fn has_panicked(&self) -> bool {
        self.failure.borrow().is_some()
    }

    fn query<R>(&mut self, query: impl FnOnce(&mut Pass<'a>) -> R) -> Option<R> {
        let given = if self.has_panicked() { None } else { guarded(|| query(&mut self.pass)) };
        if given.is_none() {
            *self.failure.borrow_mut() = Some(PANICKED.into());
        }
        given
    }
}

impl Timed for Guarded<'_> {
    fn rays(&self) -> usize {
        self.pass.rays()
    }

    fn choose(&mut self, levels: &[usize], epoch: usize) {
        self.levels = levels.len();
        self.query(|pass| pass.choose(levels, epoch));
    }

    fn clear(&mut self) {
        self.pass.clear();
    }

    fn lead_in(&mut self) {
        self.query(Pass::lead_in);
    }

    fn run(&mut self, watch: &Stopwatch) -> Vec<u64> {
        self.query(|pass| pass.run(watch)).unwrap_or_else(|| vec![0; self.levels])
    }

    fn checksum(&self) -> u64 {
        if self.has_panicked() { 0 } else { self.pass.checksum() }
    }

    fn contradicts_itself(&self) -> bool {
        !self.has_panicked() && self.pass.contradicts_itself()
    }
}
