//! Measuring: a clock, samples in random order whose answers are checked, what is printed of them, where they come from.

mod clock;
mod order;
mod pass;
mod provenance;
mod samples;
mod summary;

pub use clock::{Clock, SystemClock};
pub use order::RandomOrder;
pub use pass::{Pass, Threads, spread};
pub use provenance::Provenance;
pub use samples::{Plan, Samples, Timed, UnsteadyAnswers, take};
pub use summary::{Interval, geometric_mean, mean_ratio, median, paired_ratio};
