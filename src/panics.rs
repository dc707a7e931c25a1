//! Panics of structures, caught and not printed.

use std::cell::Cell;
use std::panic::{self, AssertUnwindSafe};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, MutexGuard, Once, PoisonError};
use std::thread;

thread_local! {
    /// Whether what panics on this thread is caught by [`caught`].
    static CATCHES: Cell<bool> = const { Cell::new(false) };
}

/// How many calls of [`caught`] run.
static CATCHING: AtomicUsize = AtomicUsize::new(0);

/// What has not been printed and not been caught yet.
static HELD_BACK: Mutex<Vec<String>> = Mutex::new(vec![]);

fn held_back() -> MutexGuard<'static, Vec<String>> {
    HELD_BACK.lock().unwrap_or_else(PoisonError::into_inner)
}

/// The result of `work`, or what it panicked with; nothing is printed then. Whoever calls this says what has happened.
///
/// Of other threads, those of rayon are quiet as well while this runs: rayon hands their panics on to whoever waits for them. If
/// nobody catches one, [`uncaught`] has its message. Panics of all other threads are printed as ever.
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

/// The messages that were held back for [`caught`], which did not catch their panics.
pub fn uncaught() -> Vec<String> {
    std::mem::take(&mut held_back())
}

#[cfg(test)]
mod tests {
    use std::process::Command;

    use rayon::prelude::*;

    use super::*;

    /// What a process of its own writes to standard error, in which one of the tests below runs.
    fn said(test: &str) -> String {
        let program = std::env::current_exe().unwrap();
        let name = format!("panics::tests::{test}");
        let output = Command::new(program)
            .args(["--ignored", "--exact", &name, "--nocapture"])
            .env("RUST_BACKTRACE", "1")
            .output()
            .unwrap();
        assert!(output.status.success(), "{test}: {}", String::from_utf8_lossy(&output.stderr));
        String::from_utf8(output.stderr).unwrap()
    }

    fn panics_in_parallel() {
        (0..64_u32).into_par_iter().for_each(|i| assert!(i != 17, "number 17"));
    }

    #[test]
    #[ignore = "run by the next test in a process of its own"]
    fn quiet() {
        assert_eq!(caught(|| 7).ok(), Some(7));
        assert!(caught(|| panic!("own")).is_err());
        assert!(caught(panics_in_parallel).is_err());
        assert!(caught(|| assert!(caught(|| panic!("inner")).is_err())).is_ok());
        assert!(caught(|| caught(|| panic!("inner")).unwrap()).is_err());
        assert!(uncaught().is_empty());
    }

    #[test]
    #[ignore = "run by the next test in a process of its own"]
    fn loud() {
        assert!(caught(|| panic!("quiet")).is_err());
        let (end, wait) = std::sync::mpsc::channel::<()>();
        thread::scope(|scope| {
            let other = scope.spawn(move || caught(|| wait.recv()));
            assert!(thread::spawn(|| panic!("loud on a thread")).join().is_err());
            assert!(panic::catch_unwind(|| panic!("loud here")).is_err());
            assert!(panic::catch_unwind(panics_in_parallel).is_err());
            assert!(uncaught()[0].contains("number 17"));
            drop(end);
            other.join().unwrap().ok();
        });
        assert!(panic::catch_unwind(|| panic!("loud at last")).is_err());
    }

    #[test]
    fn what_is_caught_is_not_printed_and_all_else_is() {
        assert_eq!(said("quiet"), "");
        let loud = said("loud");
        for message in ["loud on a thread", "loud here", "loud at last"] {
            assert!(loud.contains(message), "{loud}");
        }
        assert!(!loud.contains("quiet") && !loud.contains("number 17"), "{loud}");
    }
}
