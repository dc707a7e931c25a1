//! How many instructions a pass takes: a count that, unlike time, neither load nor clock rates change.

/// The processor's counter of instructions in user space, of the calling thread.
#[derive(Debug)]
pub struct Instructions {
    #[cfg(target_os = "linux")]
    counter: std::os::fd::OwnedFd,
}

/// Said where there is no counter.
pub const ABSENT: &str = "Instructions are not counted: the system offers no counter of them here.";

/// The first version of Linux's `perf_event_attr` (man perf_event_open).
#[cfg(target_os = "linux")]
#[repr(C)]
#[derive(Default)]
struct Attributes {
    kind: u32,
    size: u32,
    config: u64,
    sample_period: u64,
    sample_type: u64,
    read_format: u64,
    flags: u64,
    wakeup_events: u32,
    breakpoint_type: u32,
    config1: u64,
}

#[cfg(target_os = "linux")]
const _: () = assert!(size_of::<Attributes>() == 64);

#[cfg(target_os = "linux")]
impl Attributes {
    /// Instructions in user space, not counted until told so.
    fn instructions() -> Self {
        const HARDWARE: u32 = 0;
        const INSTRUCTIONS: u64 = 1;
        const DISABLED: u64 = 1;
        const EXCLUDE_KERNEL: u64 = 1 << 5;
        const EXCLUDE_HYPERVISOR: u64 = 1 << 6;
        Self {
            kind: HARDWARE,
            size: size_of::<Self>() as u32,
            config: INSTRUCTIONS,
            flags: DISABLED | EXCLUDE_KERNEL | EXCLUDE_HYPERVISOR,
            ..Self::default()
        }
    }
}

#[cfg(target_os = "linux")]
impl Instructions {
    /// Nothing where processor or kernel give none: virtual machines often have no counter, and kernels may forbid it.
    pub fn open() -> Option<Self> {
        Self::of(&Attributes::instructions())
    }

    fn of(attributes: &Attributes) -> Option<Self> {
        use std::os::fd::FromRawFd;
        let (this_thread, any_core, no_group, no_flags) = (0, -1, -1, 0);
        // SAFETY: the call reads the attributes, whose size they name, and gives a descriptor that nobody else has.
        unsafe {
            let number =
                libc::syscall(libc::SYS_perf_event_open, attributes, this_thread, any_core, no_group, no_flags);
            let number = i32::try_from(number).ok().filter(|&number| number >= 0)?;
            Some(Self { counter: std::os::fd::OwnedFd::from_raw_fd(number) })
        }
    }

    /// Instructions that `work` takes on this thread; nothing if the counter did not run all the time.
    pub fn count(&self, work: impl FnOnce()) -> Option<u64> {
        const ENABLE: u64 = 0x2400;
        const DISABLE: u64 = 0x2401;
        const RESET: u64 = 0x2403;
        self.tell(RESET)?;
        self.tell(ENABLE)?;
        work();
        self.tell(DISABLE)?;
        self.read().filter(|&n| n > 0)
    }

    fn tell(&self, request: u64) -> Option<()> {
        use std::os::fd::AsRawFd;
        // SAFETY: these requests take no argument.
        (unsafe { libc::ioctl(self.counter.as_raw_fd(), request as _, 0) } == 0).then_some(())
    }

    fn read(&self) -> Option<u64> {
        use std::os::fd::AsRawFd;
        let mut count = [0_u8; 8];
        // SAFETY: the call writes at most eight bytes into the array.
        let read = unsafe { libc::read(self.counter.as_raw_fd(), count.as_mut_ptr().cast(), count.len()) };
        (read == 8).then(|| u64::from_ne_bytes(count))
    }
}

#[cfg(not(target_os = "linux"))]
impl Instructions {
    pub fn open() -> Option<Self> {
        None
    }

    pub fn count(&self, _: impl FnOnce()) -> Option<u64> {
        None
    }
}

#[cfg(all(test, target_os = "linux"))]
mod tests {
    use super::*;

    #[test]
    fn what_the_kernel_does_not_know_is_absent() {
        assert!(Instructions::of(&Attributes { kind: u32::MAX, ..Attributes::instructions() }).is_none());
    }

    #[test]
    fn more_work_is_more_instructions_where_they_are_counted() {
        let Some(counter) = Instructions::open() else { return };
        let work = |n: u64| move || (0..n).for_each(|i| _ = std::hint::black_box(i));
        let (few, many) = (counter.count(work(1000)), counter.count(work(100_000)));
        assert!(few.is_some() && many > few.map(|few| 10 * few), "{few:?} {many:?}");
    }

    #[test]
    fn a_counter_is_read_as_the_kernel_writes_it() {
        // The kernel's own clock counts everywhere that counters are allowed: nanoseconds of this thread.
        const SOFTWARE: u32 = 1;
        const TASK_CLOCK: u64 = 1;
        let clock = Attributes { kind: SOFTWARE, config: TASK_CLOCK, ..Attributes::instructions() };
        let Some(counter) = Instructions::of(&clock) else { return };
        let start = std::time::Instant::now();
        let counted = counter.count(|| while start.elapsed().as_micros() < 2000 {});
        // As long as that on a core of its own; less when others ran.
        assert!(counted.is_some_and(|ns| ns > 1000), "{counted:?}");
    }
}
