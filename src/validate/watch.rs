//! Structures that may never answer, asked on threads that are watched.
//!
//! A thread cannot be ended from outside: one that hangs is left behind, and ends with the process.

use std::collections::BTreeMap;
use std::panic::resume_unwind;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::thread;
use std::time::Duration;

use super::asked::{Asked, Call, message};
use super::compare::{BATCH, admitted, validate_batch};
use super::{Kind, Reference, Validation};
use crate::accel::DynAccel;
use crate::geometry::{Hit, Mesh, Ray};
use crate::panics::caught;

/// How long a structure may take for its build, or for 256 rays, where nobody says otherwise: far longer than any that ends.
pub const LIMIT: Duration = Duration::from_secs(120);

const PAUSE: Duration = Duration::from_millis(20);

/// Why work on a watched thread has no result.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Ended {
    /// It was given up.
    #[error("it hangs: no answer within {0:?}")]
    Hangs(Duration),
    /// It panicked.
    #[error("it panics: {0}")]
    Panicked(String),
}

/// Runs `work` on a thread of its own and waits for `limit` at most.
///
/// # Errors
/// If the work panics, or takes longer; then its thread is left behind.
pub fn watched<R: Send + 'static>(limit: Duration, work: impl FnOnce() -> R + Send + 'static) -> Result<R, Ended> {
    let (sender, receiver) = channel();
    thread::spawn(move || {
        let result = caught(work).map_err(|payload| message(payload.as_ref()));
        // Nobody listens after the limit.
        let _ = sender.send(result);
    });
    match receiver.recv_timeout(limit) {
        Ok(result) => result.map_err(Ended::Panicked),
        Err(_) => Err(Ended::Hangs(limit)),
    }
}

/// The rays to compare, shared by threads that take batches in order.
struct Job {
    subject: Arc<dyn DynAccel>,
    reference: Arc<Reference>,
    mesh: Arc<Mesh>,
    rays: Vec<Ray>,
    /// What the reference answers.
    expected: Vec<Option<Hit>>,
    next: AtomicUsize,
}

/// A thread's place: the batch that it works on, and what it asks.
#[derive(Default)]
struct Place {
    batch: AtomicUsize,
    asked: Asked,
}

impl Job {
    /// Rays, and what is expected of them.
    fn batch(&self, number: usize) -> Option<(&[Ray], &[Option<Hit>])> {
        self.rays.chunks(BATCH).zip(self.expected.chunks(BATCH)).nth(number)
    }

    fn run(&self, number: usize, asked: &Asked) -> Option<Validation> {
        let (rays, expected) = self.batch(number)?;
        Some(validate_batch(self.subject.as_ref(), &self.reference, expected, &self.mesh, rays, asked))
    }
}

/// As [`validate`](super::validate), but a structure that takes longer than `limit` for one question, a ray or 256 of them,
/// is given up: the ray is named, and what was compared until then stands. `expected` are the answers of `reference` to `rays`.
///
/// Runs on as many threads of its own as the machine has processors. One that hangs is left behind.
pub fn validate_watched(
    subject: &Arc<dyn DynAccel>,
    reference: &Arc<Reference>,
    expected: &[Option<Hit>],
    mesh: &Arc<Mesh>,
    rays: &[Ray],
    limit: Duration,
) -> Validation {
    let (admitted, expected) = admitted(subject.as_ref(), rays, expected);
    let declined = rays.len() - admitted.len();
    let job = Arc::new(Job {
        subject: Arc::clone(subject),
        reference: Arc::clone(reference),
        mesh: Arc::clone(mesh),
        rays: admitted,
        expected,
        next: AtomicUsize::new(0),
    });

    let count = thread::available_parallelism().map_or(1, usize::from).min(job.rays.len().div_ceil(BATCH));
    let (sender, receiver) = channel();
    let places: Vec<Arc<Place>> = (0..count).map(|_| Arc::default()).collect();
    let threads: Vec<_> = places
        .iter()
        .map(|place| {
            let (job, place, sender) = (Arc::clone(&job), Arc::clone(place), sender.clone());
            thread::spawn(move || {
                loop {
                    let number = job.next.fetch_add(1, Ordering::Relaxed);
                    place.batch.store(number, Ordering::Relaxed);
                    let Some(done) = job.run(number, &place.asked) else { return };
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
        let overdue = |place: &Arc<Place>| Some((place.batch.load(Ordering::Relaxed), place.asked.overdue(limit)?));
        // Batches are taken in order: of several that hang the first is named.
        if let Some((number, call)) = places.iter().filter_map(overdue).min_by_key(|(number, _)| *number) {
            let (rays, expected) = job.batch(number).expect("it is being asked");
            let sums = Validation { rays: rays.len() as u64, ..Validation::default() };
            let why = format!("no answer within {limit:?}");
            let first = if let Call::Ray(index) = call { index } else { 0 };
            batches.insert(number, sums.ended(expected[first], rays, call, Kind::Hangs, why));
            return Validation::of_batches(declined, batches.into_values());
        }
    }
    for thread in threads {
        // What a structure panics with was caught: this is a fault of ours.
        thread.join().unwrap_or_else(|fault| resume_unwind(fault));
    }
    Validation::of_batches(declined, batches.into_values())
}
