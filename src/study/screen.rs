use std::borrow::Cow;

use serde::{Deserialize, Serialize};

use crate::report::Table;

/// The current activity of a study.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Stage<'a> {
    Build(#[serde(borrow)] Cow<'a, str>),
    Rays(#[serde(borrow)] Cow<'a, str>),
    Check(#[serde(borrow)] Cow<'a, str>),
    /// The number of samples taken so far, and the number of all samples.
    Trace(usize, usize),
    /// The work per ray is being counted.
    Count,
}

/// Shows the progress of a run. No method is called inside a timed region.
pub trait Screen {
    /// The argument is the total work of the run in an arbitrary unit.
    fn begin(&mut self, _: u64) {}
    fn case(&mut self, _title: &str, _work: u64) {}
    fn stage(&mut self, _: &Stage) {}
    /// Called at the end of each case, including failed cases.
    fn done(&mut self) {}
    fn is_interrupted(&self) -> bool {
        false
    }
    /// Whether a user sees warnings.
    fn is_watched(&self) -> bool {
        false
    }
    fn warn(&mut self, _: &[String]) {}
    fn table(&mut self, _: &Table) {}
    fn end(&mut self) {}
}
