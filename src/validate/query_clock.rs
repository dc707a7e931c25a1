//! Records the query that a thread runs, and the start time of the query.

use std::any::Any;
use std::sync::Mutex;
use std::time::{Duration, Instant};

use crate::panics::caught;

pub(super) fn message(payload: &(dyn Any + Send)) -> String {
    let text = payload.downcast_ref::<&str>().copied();
    let text = text.or_else(|| payload.downcast_ref::<String>().map(String::as_str));
    text.map_or("there is no message".into(), |text| format!("the message is {text:?}"))
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Call {
    /// A query of one ray. The number is the index of the ray.
    Ray(usize),
    Batch,
}

#[derive(Default)]
pub(super) struct QueryClock(Mutex<Option<(Call, Instant)>>);

impl QueryClock {
    /// Returns the message of a panic as an error.
    pub fn run<R>(&self, call: Call, query: impl FnOnce() -> R) -> Result<R, String> {
        self.set(Some((call, Instant::now())));
        let result = caught(query);
        self.set(None);
        result.map_err(|payload| message(payload.as_ref()))
    }

    fn set(&self, state: Option<(Call, Instant)>) {
        *self.0.lock().expect("no thread panics while it holds the lock") = state;
    }

    /// The running query, if it has taken longer than `limit`.
    pub fn overdue(&self, limit: Duration) -> Option<Call> {
        let (call, since) = (*self.0.lock().expect("no thread panics while it holds the lock"))?;
        (since.elapsed() > limit).then_some(call)
    }
}
