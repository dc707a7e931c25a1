//! Measuring: a clock, samples in random order whose answers are checked, what is printed of them, where they come from.

mod aa_noise;
pub mod advice;
mod beta;
mod clock;
mod estimate;
mod events;
pub mod interval;
pub mod machine;
mod memory;
mod order;
mod pass;
mod pin;
pub mod program;
mod provenance;
mod samples;
mod student;
mod summary;
mod threads;
pub mod tiles;
mod variance;

pub use aa_noise::AaNoise;
pub use beta::beta_quantile;
pub use clock::{Clock, CpuClock, Stopwatch, SystemClock};
pub use estimate::{Estimate, Interval};
pub use events::EventCounter;
pub use interval::{Rerun, epoch_values, log_ratios};
pub use memory::{CountingAllocator, peak_bytes};
pub use order::RandomOrder;
pub use pass::{Pass, checksum, spread};
pub use pin::{Pin, keep_to};
pub use provenance::{Provenance, quoted, words};
pub use samples::{Part, Plan, Samples, Timed, UnsteadyAnswers, begin, take};
pub use student::{LEVEL, factor, holm, two_sided};
pub use summary::{geometric_mean, median};
pub use threads::Threads;
pub use variance::Variance;
