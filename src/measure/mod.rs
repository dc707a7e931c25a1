//! Measuring: a clock, samples in random order whose answers are checked, what is printed of them, where they come from.

mod clock;
mod floor;
mod order;
mod pass;
mod provenance;
pub mod replication;
mod samples;
mod student;
mod summary;

pub use clock::{Clock, SystemClock};
pub use floor::{Difference, NoiseFloor, QUANTILE};
pub use order::RandomOrder;
pub use pass::{Pass, Threads, spread};
pub use provenance::Provenance;
pub use replication::{epoch_values, log_ratios, replicated_ratio, replication, standard_error};
pub use samples::{Plan, Samples, Timed, UnsteadyAnswers, take};
pub use summary::{Interval, geometric_mean, mean_ratio, median, paired_ratio};
