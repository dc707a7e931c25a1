use super::Stage;
use crate::report::Table;

/// Shows how far a run has come. It is never called inside a timed region.
pub trait Screen {
    /// So much is to be measured, as a multiple of any unit.
    fn begin(&mut self, work: u64);
    /// The next case is measured, which is so much of it.
    fn case(&mut self, title: &str, work: u64);
    /// What is done for it.
    fn stage(&mut self, stage: &Stage);
    /// It is measured.
    fn done(&mut self);
    /// Whether the run is to stop.
    fn is_interrupted(&self) -> bool;
    /// Whether somebody watches, who may want a first look at a scene of which not all epochs are measured.
    fn is_watched(&self) -> bool;
    /// Shows what spoils the run, or may not be what was meant.
    fn warn(&mut self, warnings: &[String]);
    /// A table of the result.
    fn table(&mut self, table: &Table);
    /// Nothing more is measured.
    fn end(&mut self);
}
