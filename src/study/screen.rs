use std::borrow::Cow;

use serde::{Deserialize, Serialize};

use crate::report::Table;

/// The current activity of a study, reported between timed regions.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Stage<'a> {
    /// A structure is being built.
    Build(#[serde(borrow)] Cow<'a, str>),
    /// Rays are being made.
    Rays(#[serde(borrow)] Cow<'a, str>),
    /// The hits of a structure are being checked.
    Check(#[serde(borrow)] Cow<'a, str>),
    /// Samples are being taken: the number taken so far, and the number of all samples.
    Trace(usize, usize),
    /// All samples of epoch 0 are taken. The work per ray is being counted: no more timing follows.
    Count,
}

/// Shows the progress of a run. It is never called inside a timed region. By default it shows nothing.
pub trait Screen {
    /// The run starts. The argument is its total work in an arbitrary unit.
    fn begin(&mut self, _: u64) {}
    /// The next case starts, with this title and work.
    fn case(&mut self, _title: &str, _work: u64) {}
    /// The case enters a stage.
    fn stage(&mut self, _: &Stage) {}
    /// The case has ended: it is measured, or it has failed.
    fn done(&mut self) {}
    /// Whether the run must stop.
    fn is_interrupted(&self) -> bool {
        false
    }
    /// Whether a user sees warnings.
    fn is_watched(&self) -> bool {
        false
    }
    /// Shows conditions that disturb the run, or options that may be unintended.
    fn warn(&mut self, _: &[String]) {}
    /// Shows a table of the result.
    fn table(&mut self, _: &Table) {}
    /// The run has ended.
    fn end(&mut self) {}
}
