//! The threads that build and trace.

use std::sync::Arc;

use super::machine;
use super::pin::{self, Pin};

/// The threads that build and trace; a clone is the same threads.
#[derive(Clone)]
pub struct Threads {
    pool: Arc<rayon::ThreadPool>,
    count: usize,
    /// The core of each, where they are bound.
    cores: Option<Vec<usize>>,
}

impl Threads {
    /// Threads that run where the system likes.
    ///
    /// # Errors
    /// If the system does not give that many threads; the sentence is its own.
    pub fn new(count: usize) -> Result<Self, String> {
        Self::on(count, None)
    }

    /// Threads each of which is bound to a core of its own, where the system allows that and has as many: to measure.
    ///
    /// # Errors
    /// As [`Threads::new`].
    pub fn pinned(count: usize) -> Result<Self, String> {
        Self::on(count, pin::choose(count))
    }

    fn on(count: usize, cores: Option<Vec<usize>>) -> Result<Self, String> {
        // What the load was before these threads made some.
        machine::load_at_start();
        let own = cores.clone();
        let bind = move |i: usize| {
            if let Some(cores) = &own {
                pin::bind(&cores[i..=i]);
            }
        };
        let pool = rayon::ThreadPoolBuilder::new().num_threads(count).start_handler(bind);
        Ok(Self { pool: Arc::new(pool.build().map_err(|error| error.to_string())?), count, cores })
    }

    /// The core of each thread; nothing where they are not bound.
    pub fn cores(&self) -> Option<&[usize]> {
        self.cores.as_deref()
    }

    /// Binds the calling thread, which traces when there is but one, until the guard is dropped. Nothing if these threads are not bound.
    pub fn pin(&self) -> Option<Pin> {
        if self.count == 1 { Pin::to(*self.cores.as_ref()?.first()?) } else { None }
    }

    pub fn count(&self) -> usize {
        self.count
    }

    /// Runs `work` on these threads: all parallel iterators in it stay on them.
    pub fn install<R: Send>(&self, work: impl FnOnce() -> R + Send) -> R {
        self.pool.install(work)
    }
}
