use super::Stage;
use crate::report::Table;

/// Shows how far a run has come. It is never called inside a timed region. By itself it shows nothing.
pub trait Screen {
    /// So much is to be measured, as a multiple of any unit.
    fn begin(&mut self, _: u64) {}
    /// The next case is measured, which is so much of it.
    fn case(&mut self, _title: &str, _work: u64) {}
    /// What is done for it.
    fn stage(&mut self, _: &Stage) {}
    /// It is measured.
    fn done(&mut self) {}
    /// Whether the run is to stop.
    fn is_interrupted(&self) -> bool {
        false
    }
    /// Whether somebody watches, who sees warnings.
    fn is_watched(&self) -> bool {
        false
    }
    /// Shows what spoils the run, or may not be what was meant.
    fn warn(&mut self, _: &[String]) {}
    /// A table of the result.
    fn table(&mut self, _: &Table) {}
    /// Nothing more is measured.
    fn end(&mut self) {}
}
