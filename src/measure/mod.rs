//! Measurements: clocks, samples, estimates with intervals, provenance.

mod aa_noise;
pub mod advice;
mod clock;
mod estimate;
pub mod interval;
pub mod machine;
mod memory;
mod order;
mod pass;
pub mod process_group;
pub mod program;
mod provenance;
mod quantiles;
mod query_results;
mod ray_allotment;
mod remote_pass;
mod samples;
mod summary;
mod threads;
pub mod tiles;

pub use aa_noise::AaNoise;
pub use clock::{Clock, CpuClock, Stopwatch, SystemClock};
pub use estimate::{Estimate, Interval};
pub use interval::{Rerun, cut_to_shared_epochs, epoch_values, log_ratios};
pub use memory::{CountingAllocator, peak_bytes};
pub use order::RandomOrder;
pub use pass::{Pass, spread};
pub use provenance::Provenance;
pub use quantiles::beta_quantile;
pub use query_results::{QueryResults, checksum};
pub use ray_allotment::{Allotment, Cost, allot, level_by_clock, pilot_level};
pub use remote_pass::{Failure, RemotePass};
pub use samples::{SamplePlan, Samples, SubsetSamples, Timed, take};
pub use summary::{Variance, mean, median};
pub use threads::{Pin, Threads, keep_to, on_all_cores};
