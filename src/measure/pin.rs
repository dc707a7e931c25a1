//! One thread, one core: a thread that moves leaves its caches behind.

use super::machine;

/// Binds the calling thread to a core until it is dropped; then the thread may run where it might before.
#[derive(Debug)]
pub struct Pin {
    before: Vec<usize>,
}

impl Pin {
    /// Binds the calling thread to `core`; nothing where the system does not allow it.
    pub fn to(core: usize) -> Option<Self> {
        let before = allowed()?;
        bind(&[core]).then_some(Self { before })
    }
}

impl Drop for Pin {
    fn drop(&mut self) {
        // It was allowed before; where it no longer is, the thread stays where it is.
        bind(&self.before);
    }
}

/// The cores for `threads` threads: those that have been the most idle during the last tenth of a second, of those the highest, for
/// interrupts go to the lowest. Nothing where threads cannot be bound, or there are fewer cores than threads.
pub fn choose(threads: usize) -> Option<Vec<usize>> {
    let mut cores = allowed()?;
    if cores.len() < threads {
        return None;
    }
    if cores.len() > threads {
        let idle = machine::idle_ticks(std::time::Duration::from_millis(100));
        cores.sort_by_key(|&core| std::cmp::Reverse((idle.get(&core).copied(), core)));
    }
    cores.truncate(threads);
    Some(cores)
}

/// The cores that the calling thread may run on.
#[cfg(target_os = "linux")]
fn allowed() -> Option<Vec<usize>> {
    // SAFETY: all zeroes is a valid set of cores, and the call writes at most its size into it.
    let set = unsafe {
        let mut set: libc::cpu_set_t = std::mem::zeroed();
        (libc::sched_getaffinity(0, size_of::<libc::cpu_set_t>(), &mut set) == 0).then_some(set)?
    };
    // SAFETY: every number is below the size of the set.
    let cores = (0..libc::CPU_SETSIZE as usize).filter(|&core| unsafe { libc::CPU_ISSET(core, &set) });
    Some(cores.collect())
}

/// Lets the calling thread run on `cores` only. Whether it worked.
#[cfg(target_os = "linux")]
pub(super) fn bind(cores: &[usize]) -> bool {
    // SAFETY: all zeroes is a valid set of cores, every number put into it is below its size, and the call reads it.
    unsafe {
        let mut set: libc::cpu_set_t = std::mem::zeroed();
        cores.iter().filter(|&&core| core < libc::CPU_SETSIZE as usize).for_each(|&core| libc::CPU_SET(core, &mut set));
        libc::sched_setaffinity(0, size_of::<libc::cpu_set_t>(), &set) == 0
    }
}

#[cfg(not(target_os = "linux"))]
fn allowed() -> Option<Vec<usize>> {
    None
}

#[cfg(not(target_os = "linux"))]
pub(super) fn bind(_: &[usize]) -> bool {
    false
}

#[cfg(all(test, target_os = "linux"))]
mod tests {
    use super::*;

    #[test]
    fn a_thread_is_bound_and_let_go() {
        let before = allowed().unwrap();
        let core = *before.last().unwrap();
        let pin = Pin::to(core).unwrap();
        assert_eq!(allowed().unwrap(), [core]);
        drop(pin);
        assert_eq!(allowed().unwrap(), before);
        assert!(Pin::to(usize::MAX).is_none(), "there is no such core");
        assert_eq!(allowed().unwrap(), before);
    }

    #[test]
    fn there_are_never_two_threads_for_one_core() {
        let cores = allowed().unwrap();
        assert_eq!(choose(1).unwrap().len(), 1);
        assert!(cores.contains(&choose(1).unwrap()[0]));
        assert_eq!(choose(cores.len() + 1), None);
    }
}
