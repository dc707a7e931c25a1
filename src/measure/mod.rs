//! Measuring: a clock, samples in random order whose answers are checked, what is printed of them, where they come from.

pub mod advice;
mod beta;
mod change;
mod clock;
mod floor;
pub mod instructions;
pub mod machine;
mod memory;
mod order;
mod pass;
mod pin;
pub mod program;
mod provenance;
pub mod replication;
mod samples;
mod student;
mod summary;
mod threads;
pub mod tiles;

pub use beta::beta_quantile;
pub use change::change;
pub use clock::{Clock, CpuClock, Stopwatch, SystemClock};
pub use floor::{Difference, NoiseFloor};
pub use instructions::Instructions;
pub use memory::{CountingAllocator, peak_bytes};
pub use order::RandomOrder;
pub use pass::{Pass, checksum, spread};
pub use pin::Pin;
pub use provenance::Provenance;
pub use replication::{epoch_values, log_ratios, prediction, replication, standard_error};
pub use samples::{Part, Plan, Samples, Timed, UnsteadyAnswers, begin, take};
pub use student::{LEVEL, factor, holm, two_sided};
pub use summary::{Interval, geometric_mean, median};
pub use threads::Threads;
