//! Clocks.

use std::time::Instant;

use super::Threads;

/// A monotonic clock. A trait, so everything that depends on time is tested without it.
pub trait Clock {
    /// Nanoseconds since some fixed moment.
    fn now_ns(&self) -> u64;
}

/// Times pieces of work, without the cost of reading the clock.
pub struct Stopwatch<'a> {
    clock: &'a dyn Clock,
    /// The cost of a reading.
    reading_ns: u64,
}

/// Readings for measuring the cost of one reading, their minimum.
const READINGS: usize = 256;

impl<'a> Stopwatch<'a> {
    /// Reads the clock a few hundred times.
    pub fn new(clock: &'a dyn Clock) -> Self {
        let reading = |_| {
            let start = clock.now_ns();
            clock.now_ns() - start
        };
        Self { clock, reading_ns: (0..READINGS).map(reading).min().unwrap_or(0) }
    }

    /// The time of `work`, ns.
    #[inline]
    pub fn time(&self, work: impl FnOnce()) -> u64 {
        let start = self.clock.now_ns();
        work();
        (self.clock.now_ns() - start).saturating_sub(self.reading_ns)
    }
}

/// The operating system's monotonic clock.
pub struct SystemClock(Instant);

impl SystemClock {
    /// A clock that counts from now.
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

/// Processor time: it stops while another program, or the host of a virtual machine, has the core. For work on one
/// thread it is the time that would elapse on an idle machine.
pub struct CpuClock(Id);

#[cfg(target_os = "linux")]
type Id = nix::time::ClockId;
#[cfg(not(target_os = "linux"))]
type Id = std::convert::Infallible;

impl CpuClock {
    /// The clock of the calling thread, for passes. `None` for several threads, or if the system has no such clock:
    /// then use the elapsed time.
    pub fn of_thread(threads: &Threads) -> Option<Self> {
        #[cfg(target_os = "linux")]
        let id = Some(Id::CLOCK_THREAD_CPUTIME_ID);
        #[cfg(not(target_os = "linux"))]
        let id = None;
        Self::of(threads, id)
    }

    /// The clock of the whole process, for builds: some builders start threads, whose work counts. `None` if
    /// [`CpuClock::of_thread`] is `None`.
    pub fn of_process(threads: &Threads) -> Option<Self> {
        #[cfg(target_os = "linux")]
        let id = Some(Id::CLOCK_PROCESS_CPUTIME_ID);
        #[cfg(not(target_os = "linux"))]
        let id = None;
        Self::of(threads, id)
    }

    fn of(threads: &Threads, id: Option<Id>) -> Option<Self> {
        let id = id.filter(|_| threads.count() == 1)?;
        cpu_time_ns(&id).map(|_| Self(id))
    }
}

impl Clock for CpuClock {
    #[inline]
    fn now_ns(&self) -> u64 {
        cpu_time_ns(&self.0).expect("it was there when the clock was made")
    }
}

#[cfg(target_os = "linux")]
fn cpu_time_ns(id: &Id) -> Option<u64> {
    let time = id.now().ok()?;
    Some(time.tv_sec() as u64 * 1_000_000_000 + time.tv_nsec() as u64)
}

#[cfg(not(target_os = "linux"))]
fn cpu_time_ns(id: &Id) -> Option<u64> {
    match *id {}
}

#[cfg(all(test, target_os = "linux"))]
mod tests {
    use super::*;

    #[test]
    fn the_clock_of_the_process_sees_other_threads() {
        let one = Threads::new(1).unwrap();
        let (thread, process) = (CpuClock::of_thread(&one).unwrap(), CpuClock::of_process(&one).unwrap());
        let (own, all) = (thread.now_ns(), process.now_ns());
        let worker = std::thread::spawn(|| {
            let clock = CpuClock::of_thread(&Threads::new(1).unwrap()).unwrap();
            let start = clock.now_ns();
            while clock.now_ns() - start < 20_000_000 {}
        });
        worker.join().unwrap();
        assert!(process.now_ns() - all >= 20_000_000 && thread.now_ns() - own < 20_000_000);
        assert!(CpuClock::of_process(&Threads::new(2).unwrap()).is_none());
    }
}
