//! Events that the processor counts: instructions, which unlike times depend neither on load nor on clock rates, and
//! branch misses.

/// The processor's counter of one kind of event, in user space and for the calling thread.
pub struct EventCounter {
    #[cfg(target_os = "linux")]
    counter: perf_event::Counter,
}

#[cfg(target_os = "linux")]
impl EventCounter {
    /// Counts instructions. `None` if processor or kernel provide no counter: virtual machines often have none, and
    /// kernels may forbid it.
    pub fn instructions() -> Option<Self> {
        Self::of(perf_event::events::Hardware::INSTRUCTIONS)
    }

    /// Counts mispredicted branches. `None` as above.
    pub fn branch_misses() -> Option<Self> {
        Self::of(perf_event::events::Hardware::BRANCH_MISSES)
    }

    fn of(event: impl perf_event::events::Event) -> Option<Self> {
        let mut counter = perf_event::Builder::new(event);
        counter.pinned(true).exclude_kernel(true).exclude_hv(true);
        Some(Self { counter: counter.build().ok()? })
    }

    /// The number of events in `work` on this thread; `None` if the counter did not run all the time.
    pub fn count(&mut self, work: impl FnOnce()) -> Option<u64> {
        self.counter.reset().ok()?;
        self.counter.enable().ok()?;
        work();
        self.counter.disable().ok()?;
        // A pinned counter that lost its hardware to another one cannot be read.
        self.counter.read().ok().filter(|&count| count > 0)
    }
}

#[cfg(not(target_os = "linux"))]
impl EventCounter {
    pub fn instructions() -> Option<Self> {
        None
    }

    pub fn branch_misses() -> Option<Self> {
        None
    }

    pub fn count(&mut self, _: impl FnOnce()) -> Option<u64> {
        None
    }
}

#[cfg(all(test, target_os = "linux"))]
mod tests {
    use std::hint::black_box;

    use super::*;

    /// The kernel's clock, nanoseconds of this thread, counts on every machine that allows counters; the processor's
    /// counters may not exist, or never be scheduled.
    #[test]
    fn what_is_counted_grows_with_the_work() {
        let work = |n: u64| move || (0..n).for_each(|i| _ = black_box(i));
        let clock = EventCounter::of(perf_event::events::Software::TASK_CLOCK);
        for (counter, is_sure) in [(clock, true), (EventCounter::instructions(), false)] {
            let Some(mut counter) = counter else { continue };
            let [few, many] = [1000, 1_000_000].map(|n| counter.count(work(n)));
            assert!(few.is_some() || !is_sure);
            assert!(few.is_none() || many > few.map(|few| 10 * few), "{few:?} {many:?}");
        }
    }
}
