//! Runs queries that may never return, on threads with a time limit.
//!
//! A thread cannot end another thread. A hanging thread therefore runs until the process ends.

use std::collections::BTreeMap;
use std::panic::resume_unwind;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::thread;
use std::time::Duration;

use super::compare::{BATCH, ExpectedHits, not_declined, validate_batch};
use super::query_clock::{QueryClock, message};
use super::{Kind, Reference, Validation};
use crate::accel::DynAccel;
use crate::geometry::{Hit, Mesh, Ray};
use crate::panics::caught;

/// Default time limit of a build or a query. Without a hang, a build or a batch of 256 rays takes far less.
pub const LIMIT: Duration = Duration::from_secs(120);

const PAUSE: Duration = Duration::from_millis(20);

#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum WatchError {
    #[error("it hangs: no result within {0:?}")]
    Hangs(Duration),
    #[error("it panics: {0}")]
    Panicked(String),
}

/// Runs `work` on a separate thread and waits for at most `limit`.
///
/// # Errors
/// If `work` panics or takes longer than `limit`.
pub fn watched<R: Send + 'static>(limit: Duration, work: impl FnOnce() -> R + Send + 'static) -> Result<R, WatchError> {
    let (sender, receiver) = channel();
    thread::spawn(move || {
        let result = caught(work).map_err(|payload| message(payload.as_ref()));
        // After the limit, the receiver no longer exists.
        let _ = sender.send(result);
    });
    match receiver.recv_timeout(limit) {
        Ok(result) => result.map_err(WatchError::Panicked),
        Err(_) => Err(WatchError::Hangs(limit)),
    }
}

struct Comparison {
    subject: Arc<dyn DynAccel>,
    reference: Arc<Reference>,
    mesh: Arc<Mesh>,
    rays: Vec<Ray>,
    expected: Vec<Option<Hit>>,
    next: AtomicUsize,
}

#[derive(Default)]
struct ThreadState {
    batch: AtomicUsize,
    clock: QueryClock,
}

impl Comparison {
    fn batch(&self, number: usize) -> Option<ExpectedHits<'_>> {
        let (rays, hits) = self.rays.chunks(BATCH).zip(self.expected.chunks(BATCH)).nth(number)?;
        Some(ExpectedHits { reference: &self.reference, mesh: &self.mesh, rays, hits })
    }
}

/// Like [`validate`](super::validate), but ends if a query takes longer than `limit`. The result then contains only
/// finished batches and the hang.
///
/// `expected` contains the hits of `reference` for `rays`.
pub fn validate_watched(
    subject: &Arc<dyn DynAccel>,
    reference: &Arc<Reference>,
    expected: &[Option<Hit>],
    mesh: &Arc<Mesh>,
    rays: &[Ray],
    limit: Duration,
) -> Validation {
    let (not_declined, expected) = not_declined(subject.as_ref(), rays, expected);
    let declined = rays.len() - not_declined.len();
    let comparison = Arc::new(Comparison {
        subject: Arc::clone(subject),
        reference: Arc::clone(reference),
        mesh: Arc::clone(mesh),
        rays: not_declined,
        expected,
        next: AtomicUsize::new(0),
    });

    let count = thread::available_parallelism().map_or(1, usize::from).min(comparison.rays.len().div_ceil(BATCH));
    let (sender, receiver) = channel();
    let states: Vec<Arc<ThreadState>> = (0..count).map(|_| Arc::default()).collect();
    let threads: Vec<_> = states
        .iter()
        .map(|state| {
            let (comparison, state, sender) = (Arc::clone(&comparison), Arc::clone(state), sender.clone());
            thread::spawn(move || {
                loop {
                    let number = comparison.next.fetch_add(1, Ordering::Relaxed);
                    state.batch.store(number, Ordering::Relaxed);
                    let Some(batch) = comparison.batch(number) else { return };
                    let done = validate_batch(comparison.subject.as_ref(), &batch, &state.clock);
                    if sender.send((number, done)).is_err() {
                        return;
                    }
                }
            })
        })
        .collect();
    drop(sender);

    let mut batches: BTreeMap<usize, Validation> = BTreeMap::new();
    loop {
        match receiver.recv_timeout(PAUSE) {
            Ok((number, done)) => drop(batches.insert(number, done)),
            Err(RecvTimeoutError::Disconnected) => break,
            Err(RecvTimeoutError::Timeout) => {}
        }
        let overdue = |state: &Arc<ThreadState>| {
            let call = state.clock.overdue(limit)?;
            Some((state.batch.load(Ordering::Relaxed), call))
        };
        // If several batches hang, report the batch with the lowest number.
        if let Some((number, call)) = states.iter().filter_map(overdue).min_by_key(|(number, _)| *number) {
            let batch = comparison.batch(number).expect("a thread compares it");
            batches.insert(number, batch.ended(call, Kind::Hangs, format!("no result within {limit:?}")));
            return Validation::of_batches(declined, batches.into_values());
        }
    }
    for thread in threads {
        // Panics of the structure are caught, so a panic of the thread is a defect of this crate.
        thread.join().unwrap_or_else(|fault| resume_unwind(fault));
    }
    Validation::of_batches(declined, batches.into_values())
}
