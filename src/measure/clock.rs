//! Where time comes from.

use std::time::Instant;

use super::Threads;

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

/// The time that the calling thread has had a processor for: it stands still while another program has the core, or the host of a
/// virtual machine. For work on one thread, which a pass on one thread is, it is the elapsed time of a machine of one's own.
pub struct ThreadClock(());

impl ThreadClock {
    /// Nothing for several threads, or where the system has no such clock: then time that elapses has to do.
    pub fn of(threads: &Threads) -> Option<Self> {
        (threads.count() == 1 && cpu_time_ns().is_some()).then_some(Self(()))
    }
}

impl Clock for ThreadClock {
    #[inline]
    fn now_ns(&self) -> u64 {
        cpu_time_ns().expect("it was there when the clock was made")
    }
}

#[cfg(target_os = "linux")]
fn cpu_time_ns() -> Option<u64> {
    let mut time = libc::timespec { tv_sec: 0, tv_nsec: 0 };
    // SAFETY: the call writes the time.
    let failed = unsafe { libc::clock_gettime(libc::CLOCK_THREAD_CPUTIME_ID, &mut time) };
    (failed == 0).then(|| time.tv_sec as u64 * 1_000_000_000 + time.tv_nsec as u64)
}

#[cfg(not(target_os = "linux"))]
fn cpu_time_ns() -> Option<u64> {
    None
}

#[cfg(all(test, target_os = "linux"))]
mod tests {
    use super::*;

    #[test]
    fn the_clock_of_a_thread_stands_still_while_it_waits() {
        let clock = ThreadClock::of(&Threads::new(1).unwrap()).unwrap();
        let (before, wall) = (clock.now_ns(), SystemClock::start());
        std::thread::sleep(std::time::Duration::from_millis(50));
        let waited = clock.now_ns() - before;
        assert!(waited < wall.now_ns() / 2, "{waited} ns");
        while clock.now_ns() - before < waited + 1_000_000 {}
        assert!(ThreadClock::of(&Threads::new(2).unwrap()).is_none());
    }
}
