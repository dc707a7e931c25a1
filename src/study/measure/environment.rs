//! Conditions of the measuring thread during the sampling.

use serde::{Deserialize, Serialize};

use crate::measure::{Clock, machine};

/// An optional field is `None` if the system does not report the value.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Environment {
    /// The process id.
    pub process: u32,
    pub seconds: f64,
    /// The number of involuntary context switches of the measuring thread.
    pub interruptions: Option<u64>,
    /// Clock rates of the thread's core at the beginning and at the end, kHz.
    pub clock_rates: Option<(f64, f64)>,
}

impl Environment {
    /// The calling thread must run on core `core`.
    pub fn during<R>(clock: &dyn Clock, core: usize, work: impl FnOnce() -> R) -> (R, Self) {
        let (interruptions, clock_rate) = (machine::interruptions(), machine::clock_rate(core));
        let start_ns = clock.now_ns();
        let result = work();
        let environment = Self {
            process: std::process::id(),
            seconds: (clock.now_ns() - start_ns) as f64 * 1e-9,
            interruptions: interruptions.zip(machine::interruptions()).map(|(from, to)| to.saturating_sub(from)),
            clock_rates: clock_rate.zip(machine::clock_rate(core)),
        };
        (result, environment)
    }

    /// `epochs` must be in ascending order of the epoch number.
    pub fn of_all<'a>(epochs: impl IntoIterator<Item = &'a Self>) -> Self {
        let sum = |all: Self, own: &Self| Self {
            process: 0,
            seconds: all.seconds + own.seconds,
            interruptions: own.interruptions.map(|n| all.interruptions.unwrap_or(0) + n).or(all.interruptions),
            // The rate at the beginning of the first epoch and the rate at the end of the last epoch.
            clock_rates: own.clock_rates.map(|own| (all.clock_rates.unwrap_or(own).0, own.1)).or(all.clock_rates),
        };
        epochs.into_iter().fold(Self::default(), sum)
    }
}
