//! How many instructions a pass takes: a count that, unlike time, neither load nor clock rates change.

/// The processor's counter of instructions in user space, of the calling thread.
pub struct Instructions {
    #[cfg(target_os = "linux")]
    counter: perf_event::Counter,
}

/// Said where there is no counter.
pub const ABSENT: &str = "Instructions are not counted: the system offers no counter of them here.";

#[cfg(target_os = "linux")]
impl Instructions {
    /// Nothing where processor or kernel give none: virtual machines often have no counter, and kernels may forbid it.
    pub fn open() -> Option<Self> {
        Self::of(perf_event::events::Hardware::INSTRUCTIONS)
    }

    fn of(event: impl perf_event::events::Event) -> Option<Self> {
        let mut counter = perf_event::Builder::new(event);
        counter.pinned(true).exclude_kernel(true).exclude_hv(true);
        Some(Self { counter: counter.build().ok()? })
    }

    /// Instructions that `work` takes on this thread; nothing if the counter did not run all the time.
    pub fn count(&mut self, work: impl FnOnce()) -> Option<u64> {
        self.counter.reset().ok()?;
        self.counter.enable().ok()?;
        work();
        self.counter.disable().ok()?;
        // A pinned counter that had to make way for another cannot be read.
        self.counter.read().ok().filter(|&count| count > 0)
    }
}

#[cfg(not(target_os = "linux"))]
impl Instructions {
    pub fn open() -> Option<Self> {
        None
    }

    pub fn count(&mut self, _: impl FnOnce()) -> Option<u64> {
        None
    }
}

#[cfg(all(test, target_os = "linux"))]
mod tests {
    use super::*;

    #[test]
    fn more_work_is_more_instructions_where_they_are_counted() {
        let Some(mut counter) = Instructions::open() else { return };
        let work = |n: u64| move || (0..n).for_each(|i| _ = std::hint::black_box(i));
        let (few, many) = (counter.count(work(1000)), counter.count(work(100_000)));
        assert!(few.is_some() && many > few.map(|few| 10 * few), "{few:?} {many:?}");
    }

    #[test]
    fn a_counter_is_read_as_the_kernel_writes_it() {
        // The kernel's own clock counts everywhere that counters are allowed: nanoseconds of this thread.
        let Some(mut counter) = Instructions::of(perf_event::events::Software::TASK_CLOCK) else { return };
        let start = std::time::Instant::now();
        let counted = counter.count(|| while start.elapsed().as_micros() < 2000 {});
        // As long as that on a core of its own; less when others ran.
        assert!(counted.is_some_and(|ns| ns > 1000), "{counted:?}");
    }
}
