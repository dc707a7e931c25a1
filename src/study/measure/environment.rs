//! Conditions of the measuring thread during the sampling.

use serde::{Deserialize, Serialize};

use crate::measure::advice::Conditions;
use crate::measure::{Clock, machine};

/// Conditions of the measuring thread during the sampling. `None` if the system does not report a value.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Environment {
    /// Number of the process.
    pub process: u32,
    pub seconds: f64,
    /// How often another thread preempted it.
    pub interruptions: Option<u64>,
    /// Clock rate of its core at the beginning and at the end, kHz.
    pub clock_rates: Option<(f64, f64)>,
}

impl Environment {
    /// Adds this epoch to those before it.
    pub fn add_to(&self, conditions: &mut Conditions) {
        conditions.seconds += self.seconds;
        if let Some(interruptions) = self.interruptions {
            *conditions.interruptions.get_or_insert(0) += interruptions;
        }
        // From the first epoch to the last.
        if let Some((before, after)) = self.clock_rates {
            let first = conditions.clock_rates.map_or(before, |(first, _)| first);
            conditions.clock_rates = Some((first, after));
        }
    }
}

/// Observes the thread before and after the sampling.
pub struct EnvironmentProbe {
    start_ns: u64,
    interruptions: Option<u64>,
    core: usize,
    clock_rate: Option<f64>,
}

impl EnvironmentProbe {
    pub fn start(clock: &dyn Clock, core: usize) -> Self {
        let (interruptions, clock_rate) = (machine::interruptions(), machine::clock_rate(core));
        Self { start_ns: clock.now_ns(), interruptions, core, clock_rate }
    }

    pub fn end(self, clock: &dyn Clock) -> Environment {
        let since = |(before, after): (u64, u64)| after.saturating_sub(before);
        Environment {
            process: std::process::id(),
            seconds: (clock.now_ns() - self.start_ns) as f64 * 1e-9,
            interruptions: self.interruptions.zip(machine::interruptions()).map(since),
            clock_rates: self.clock_rate.zip(machine::clock_rate(self.core)),
        }
    }
}
