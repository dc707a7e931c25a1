//! Catches panics of structures. Caught panics are not printed.

use std::cell::Cell;
use std::panic::{self, AssertUnwindSafe};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, MutexGuard, Once, PoisonError};
use std::thread;

thread_local! {
    /// Whether [`caught`] runs on this thread.
    static CATCHES: Cell<bool> = const { Cell::new(false) };
}

/// The number of running calls of [`caught`].
static CATCHING: AtomicUsize = AtomicUsize::new(0);

/// Messages of panics that were not printed. A caught panic clears these messages.
static HELD_BACK: Mutex<Vec<String>> = Mutex::new(vec![]);

fn held_back() -> MutexGuard<'static, Vec<String>> {
    HELD_BACK.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Returns the result of `work`. If `work` panics, returns the payload of the panic.
///
/// The panic is not printed. The caller must report the panic.
///
/// While `work` runs, no panic on a rayon thread is printed. If such a panic is not caught, [`uncaught`] returns the
/// message.
pub fn caught<R>(work: impl FnOnce() -> R) -> thread::Result<R> {
    static HOOK: Once = Once::new();
    HOOK.call_once(|| {
        let print = panic::take_hook();
        panic::set_hook(Box::new(move |info| {
            let of_rayon = || CATCHING.load(Ordering::Relaxed) > 0 && rayon::current_thread_index().is_some();
            if CATCHES.get() || of_rayon() { held_back().push(info.to_string()) } else { print(info) }
        }));
    });
    let outer = CATCHES.replace(true);
    CATCHING.fetch_add(1, Ordering::Relaxed);
    let result = panic::catch_unwind(AssertUnwindSafe(work));
    CATCHING.fetch_sub(1, Ordering::Relaxed);
    CATCHES.set(outer);
    if result.is_err() {
        held_back().clear();
    }
    result
}

/// Removes and returns the messages of panics that were neither printed nor caught.
pub fn uncaught() -> Vec<String> {
    std::mem::take(&mut held_back())
}

#[cfg(test)]
mod tests {
    use rayon::prelude::*;

    use super::*;

    fn panics_in_parallel() {
        (0..64_u32).into_par_iter().for_each(|i| assert!(i != 17, "number 17"));
    }

    #[test]
    fn what_panics_is_caught_on_threads_of_rayon_as_well_and_all_else_is_not() {
        assert_eq!(caught(|| 7).ok(), Some(7));
        assert!(caught(|| panic!("own")).is_err());
        assert!(caught(panics_in_parallel).is_err());
        assert!(caught(|| assert!(caught(|| panic!("inner")).is_err())).is_ok());
        assert!(caught(|| caught(|| panic!("inner")).unwrap()).is_err());
        assert!(thread::spawn(|| panic!("loud on a thread")).join().is_err());
    }
}
