//! The threads that build and trace.

use std::sync::{Arc, OnceLock};

use super::machine;
use super::pin::{self, Pin};

/// The threads that build and trace; clones share them.
#[derive(Clone)]
pub struct Threads {
    /// Empty until they start.
    pool: Arc<OnceLock<rayon::ThreadPool>>,
    count: usize,
    /// The core of each thread, if they are bound.
    cores: Option<Vec<usize>>,
}

impl Threads {
    /// Threads for measurements: each is bound to its own core if the system allows it and has enough cores.
    ///
    /// # Errors
    /// If the system does not provide that many threads.
    pub fn pinned(count: usize) -> Result<Self, String> {
        let threads = Self::unstarted(count);
        let pool = threads.start()?;
        Ok(Self { pool: Arc::new(OnceLock::from(pool)), ..threads })
    }

    /// Like [`Threads::pinned`], but the threads start with their first work: if they have none, starting them would
    /// only disturb the timed thread.
    pub fn unstarted(count: usize) -> Self {
        // Read the load before these threads add to it.
        machine::load_at_start();
        Self { pool: Arc::default(), count, cores: pin::choose(count) }
    }

    fn start(&self) -> Result<rayon::ThreadPool, String> {
        let own = self.cores.clone();
        let bind = move |i: usize| {
            if let Some(cores) = &own {
                pin::bind(&cores[i..=i]);
            }
        };
        let pool = rayon::ThreadPoolBuilder::new().num_threads(self.count).start_handler(bind);
        pool.build().map_err(|error| {
            format!("the system cannot start {} threads ({error}): lower --threads, or raise the limit", self.count)
        })
    }

    /// Checks before a long run whether the system provides this many threads: starts and ends them, unless they
    /// already run.
    ///
    /// # Errors
    /// As [`Threads::pinned`].
    pub fn are_given(&self) -> Result<(), String> {
        if self.pool.get().is_some() { Ok(()) } else { self.start().map(drop) }
    }

    /// The core of each thread; `None` if they are not bound.
    pub fn cores(&self) -> Option<&[usize]> {
        self.cores.as_deref()
    }

    /// Binds the calling thread until the guard is dropped; with one thread the caller itself traces. `None` if these
    /// threads are not bound.
    pub fn pin(&self) -> Option<Pin> {
        if self.count == 1 { Pin::to(*self.cores.as_ref()?.first()?) } else { None }
    }

    pub fn count(&self) -> usize {
        self.count
    }

    /// Runs `work` on these threads, including all parallel iterators in it.
    ///
    /// # Panics
    /// If they are [unstarted](Self::unstarted) and the system does not provide that many.
    pub fn install<R: Send>(&self, work: impl FnOnce() -> R + Send) -> R {
        let start = || self.start().unwrap_or_else(|cause| panic!("{cause}"));
        self.pool.get_or_init(start).install(work)
    }
}
