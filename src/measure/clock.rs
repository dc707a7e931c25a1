//! Where time comes from.

use std::time::Instant;

/// A clock that never goes back. Behind a trait, so that everything that depends on time is tested without it.
pub trait Clock {
    /// Nanoseconds since some fixed moment.
    fn now_ns(&self) -> u64;
}

/// The operating system's monotonic clock.
pub struct SystemClock(Instant);

impl SystemClock {
    /// Counts from now.
    pub fn start() -> Self {
        Self(Instant::now())
    }
}

impl Clock for SystemClock {
    #[inline]
    fn now_ns(&self) -> u64 {
        self.0.elapsed().as_nanos() as u64
    }
}
