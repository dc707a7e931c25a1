//! Clocks.

use std::time::Instant;

use super::Threads;

pub trait Clock {
    /// The clock's time in nanoseconds, from a fixed zero.
    fn now_ns(&self) -> u64;
}

/// Measures durations without the cost of reading the clock.
pub struct Stopwatch<'a> {
    clock: &'a dyn Clock,
    reading_ns: u64,
}

const READINGS: usize = 256;

impl<'a> Stopwatch<'a> {
    pub fn new(clock: &'a dyn Clock) -> Self {
        let reading = |_| {
            let start = clock.now_ns();
            clock.now_ns() - start
        };
        Self { clock, reading_ns: (0..READINGS).map(reading).min().unwrap_or(0) }
    }

    /// Returns nanoseconds.
    #[inline]
    pub fn time(&self, work: impl FnOnce()) -> u64 {
        let start = self.clock.now_ns();
        work();
        (self.clock.now_ns() - start).saturating_sub(self.reading_ns)
    }
}

pub struct SystemClock(Instant);

impl SystemClock {
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

/// Processor time. The clock stops while another program, or the host of a virtual machine, uses the core.
#[derive(Clone, Copy)]
pub enum CpuClock {
    /// The processor time of the calling thread.
    Thread,
    /// The processor time of all threads of the process.
    Process,
}

impl CpuClock {
    /// Returns `None` with several threads, or if the system does not have the clock.
    pub fn on(self, threads: &Threads) -> Option<Self> {
        (threads.count() == 1 && self.read_ns().is_some()).then_some(self)
    }

    #[cfg(target_os = "linux")]
    fn read_ns(self) -> Option<u64> {
        use nix::time::ClockId;
        let id = match self {
            Self::Thread => ClockId::CLOCK_THREAD_CPUTIME_ID,
            Self::Process => ClockId::CLOCK_PROCESS_CPUTIME_ID,
        };
        let time = id.now().ok()?;
        Some(time.tv_sec() as u64 * 1_000_000_000 + time.tv_nsec() as u64)
    }

    #[cfg(not(target_os = "linux"))]
    fn read_ns(self) -> Option<u64> {
        None
    }
}

impl Clock for CpuClock {
    #[inline]
    fn now_ns(&self) -> u64 {
        self.read_ns().expect("the system had this clock before the work")
    }
}

#[cfg(all(test, target_os = "linux"))]
mod tests {
    use super::*;

    #[test]
    fn the_clock_of_the_process_sees_other_threads() {
        let one = Threads::unstarted(1);
        let [thread, process] = [CpuClock::Thread, CpuClock::Process].map(|clock| clock.on(&one).unwrap());
        let (own, all) = (thread.now_ns(), process.now_ns());
        let worker = std::thread::spawn(|| {
            let start = CpuClock::Thread.now_ns();
            while CpuClock::Thread.now_ns() - start < 20_000_000 {}
        });
        worker.join().unwrap();
        assert!(process.now_ns() - all >= 20_000_000 && thread.now_ns() - own < 20_000_000);
        assert!(CpuClock::Process.on(&Threads::unstarted(2)).is_none());
    }
}
