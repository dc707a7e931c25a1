//! The threads that build and trace, bound to cores.

use std::sync::{Arc, OnceLock};

#[cfg(target_os = "linux")]
use nix::{
    sched::{CpuSet, sched_getaffinity, sched_setaffinity},
    unistd::Pid,
};

use super::machine;

/// Clones share the same threads.
#[derive(Clone)]
pub struct Threads {
    pool: Arc<OnceLock<rayon::ThreadPool>>,
    count: usize,
    cores: Option<Vec<usize>>,
}

impl Threads {
    /// Binds each thread to a separate core if possible.
    ///
    /// # Errors
    /// If the system does not provide `count` threads.
    pub fn pinned(count: usize) -> Result<Self, String> {
        let threads = Self::unstarted(count);
        let pool = threads.start()?;
        Ok(Self { pool: Arc::new(OnceLock::from(pool)), ..threads })
    }

    /// The threads start at the first call of [`install`](Self::install), because idle threads would disturb the timed
    /// thread.
    pub fn unstarted(count: usize) -> Self {
        // The load average must be read before the threads start.
        machine::load_at_start();
        Self { pool: Arc::default(), count, cores: choose(count) }
    }

    fn start(&self) -> Result<rayon::ThreadPool, String> {
        let own = self.cores.clone();
        let bind = move |i: usize| {
            if let Some(cores) = &own {
                bind(&cores[i..=i]);
            }
        };
        let pool = rayon::ThreadPoolBuilder::new().num_threads(self.count).start_handler(bind);
        pool.build().map_err(|error| {
            format!("the system cannot start {} threads ({error}): lower --threads, or raise the limit", self.count)
        })
    }

    /// Checks that the system can start the threads.
    ///
    /// # Errors
    /// If the system does not provide the threads.
    pub fn check_available(&self) -> Result<(), String> {
        if self.pool.get().is_some() { Ok(()) } else { self.start().map(drop) }
    }

    pub fn cores(&self) -> Option<&[usize]> {
        self.cores.as_deref()
    }

    /// Binds the calling thread if `count` is 1, because the calling thread then traces. `None` if the calling thread
    /// was not bound.
    pub fn pin(&self) -> Option<Pin> {
        if self.count == 1 { Pin::to(*self.cores.as_ref()?.first()?) } else { None }
    }

    pub fn count(&self) -> usize {
        self.count
    }

    /// # Panics
    /// If the threads are [unstarted](Self::unstarted) and the system cannot start them.
    pub fn install<R: Send>(&self, work: impl FnOnce() -> R + Send) -> R {
        let start = || self.start().unwrap_or_else(|cause| panic!("{cause}"));
        self.pool.get_or_init(start).install(work)
    }
}

/// The number 0 denotes the calling thread in system calls.
const THIS_THREAD: u32 = 0;

/// Dropping the `Pin` restores the previous cores of the thread.
#[derive(Debug)]
pub struct Pin {
    before: Vec<usize>,
}

impl Pin {
    pub fn to(core: usize) -> Option<Self> {
        let before = allowed(THIS_THREAD)?;
        bind(&[core]).then_some(Self { before })
    }
}

impl Drop for Pin {
    fn drop(&mut self) {
        // If the system no longer allows the previous cores, the thread keeps the present cores.
        bind(&self.before);
    }
}

static CORES: OnceLock<Vec<usize>> = OnceLock::new();

/// Every later [`Threads`] with `cores.len()` threads uses `cores`, if the system allows all of them. Only the first
/// call has an effect.
pub fn keep_to(cores: &[usize]) {
    CORES.get_or_init(|| cores.into());
}

/// Chooses the cores with the most idle time. Among equally idle cores, cores with high numbers are preferred, because
/// interrupts use cores with low numbers. `None` if the threads cannot get separate cores.
fn choose(threads: usize) -> Option<Vec<usize>> {
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

/// During `work`, the calling thread may use all cores of the main thread. Programs that `work` starts inherit these
/// cores.
pub fn on_all_cores<R>(work: impl FnOnce() -> R) -> R {
    // The number of the main thread is the process id.
    let _pin = allowed(std::process::id()).zip(allowed(THIS_THREAD)).map(|(all, before)| {
        bind(&all);
        Pin { before }
    });
    work()
}

#[cfg(target_os = "linux")]
fn allowed(thread: u32) -> Option<Vec<usize>> {
    let set = sched_getaffinity(Pid::from_raw(thread as i32)).ok()?;
    Some((0..CpuSet::count()).filter(|&core| set.is_set(core).unwrap_or(false)).collect())
}

#[cfg(target_os = "linux")]
fn bind(cores: &[usize]) -> bool {
    let (thread, mut set) = (Pid::from_raw(THIS_THREAD as i32), CpuSet::new());
    cores.iter().all(|&core| set.set(core).is_ok()) && sched_setaffinity(thread, &set).is_ok()
}

#[cfg(not(target_os = "linux"))]
fn allowed(_: u32) -> Option<Vec<usize>> {
    None
}

#[cfg(not(target_os = "linux"))]
fn bind(_: &[usize]) -> bool {
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
