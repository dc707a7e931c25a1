//! Binds threads to cores, which keeps their caches warm.

use std::sync::OnceLock;

#[cfg(target_os = "linux")]
use nix::{
    sched::{CpuSet, sched_getaffinity, sched_setaffinity},
    unistd::Pid,
};

use super::machine;

/// The number of the calling thread in system calls. The first thread of a process has the number of the process.
const THIS_THREAD: u32 = 0;

/// Binds the calling thread to a core until it is dropped; then the thread may run on its previous cores.
#[derive(Debug)]
pub struct Pin {
    before: Vec<usize>,
}

impl Pin {
    /// Binds the calling thread to `core`; `None` if the system does not allow it.
    pub fn to(core: usize) -> Option<Self> {
        let before = allowed(THIS_THREAD)?;
        bind(&[core]).then_some(Self { before })
    }
}

impl Drop for Pin {
    fn drop(&mut self) {
        // If the system no longer allows these cores, the thread stays on its core.
        bind(&self.before);
    }
}

/// The cores that the run has chosen for all of its processes.
static CORES: OnceLock<Vec<usize>> = OnceLock::new();

/// Gives these cores to all later groups of `cores.len()` threads, instead of the currently idle cores.
pub fn keep_to(cores: &[usize]) {
    CORES.get_or_init(|| cores.into());
}

/// The cores for `threads` threads: the cores of [`keep_to`], or the cores that were the most idle during a tenth of a
/// second; among equals the highest, because interrupts use the lowest. `None` if threads cannot be bound, or there are
/// fewer cores than threads.
pub fn choose(threads: usize) -> Option<Vec<usize>> {
    let mut cores = allowed(THIS_THREAD)?;
    if let Some(chosen) = CORES.get().filter(|chosen| chosen.len() == threads) {
        return chosen.iter().all(|core| cores.contains(core)).then(|| chosen.clone());
    }
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

/// Runs `work`, which starts a program. The program may use all cores of this process's first thread, because a program
/// inherits the cores of the thread that starts it.
pub fn on_all_cores<R>(work: impl FnOnce() -> R) -> R {
    let _pin = allowed(std::process::id()).zip(allowed(THIS_THREAD)).map(|(all, before)| {
        bind(&all);
        Pin { before }
    });
    work()
}

/// The cores that a thread may run on.
#[cfg(target_os = "linux")]
fn allowed(thread: u32) -> Option<Vec<usize>> {
    let set = sched_getaffinity(Pid::from_raw(thread as i32)).ok()?;
    Some((0..CpuSet::count()).filter(|&core| set.is_set(core).unwrap_or(false)).collect())
}

/// Restricts the calling thread to `cores`. Returns whether it worked.
#[cfg(target_os = "linux")]
pub(super) fn bind(cores: &[usize]) -> bool {
    let (thread, mut set) = (Pid::from_raw(THIS_THREAD as i32), CpuSet::new());
    cores.iter().all(|&core| set.set(core).is_ok()) && sched_setaffinity(thread, &set).is_ok()
}

#[cfg(not(target_os = "linux"))]
fn allowed(_: u32) -> Option<Vec<usize>> {
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
        let before = allowed(THIS_THREAD).unwrap();
        let core = *before.last().unwrap();
        let pin = Pin::to(core).unwrap();
        assert_eq!(allowed(THIS_THREAD).unwrap(), [core]);
        drop(pin);
        assert_eq!(allowed(THIS_THREAD).unwrap(), before);
        assert!(Pin::to(usize::MAX).is_none(), "there is no such core");
        assert_eq!(allowed(THIS_THREAD).unwrap(), before);
    }

    #[test]
    fn a_bound_thread_starts_programs_that_are_not() {
        let before = allowed(THIS_THREAD).unwrap();
        // The first thread of the test program is not bound.
        let first = allowed(std::process::id()).unwrap();
        let pin = Pin::to(before[0]).unwrap();
        assert_eq!(on_all_cores(|| allowed(THIS_THREAD).unwrap()), first);
        assert_eq!(allowed(THIS_THREAD).unwrap(), [before[0]]);
        drop(pin);
    }

    #[test]
    fn there_are_never_two_threads_for_one_core() {
        let cores = allowed(THIS_THREAD).unwrap();
        assert_eq!(choose(1).unwrap().len(), 1);
        assert!(cores.contains(&choose(1).unwrap()[0]));
        assert_eq!(choose(cores.len() + 1), None);
    }
}
