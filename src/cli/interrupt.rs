//! Ctrl-C: a measuring run stops, shows its results and keeps them; all other commands end at once, and so does the run
//! at the second Ctrl-C. SIGTERM ends everything at once, because `timeout` and schedulers, which send it, do not wait.

use std::io::Write;
use std::process::ExitCode;
use std::sync::atomic::{AtomicBool, Ordering};

#[cfg(target_os = "linux")]
use nix::sys::signal::{SigSet, Signal, raise};

/// Whether a run stops by itself on a signal.
static LISTENS: AtomicBool = AtomicBool::new(false);
static ASKED: AtomicBool = AtomicBool::new(false);
/// Whether a signal is ending this process.
static ENDING: AtomicBool = AtomicBool::new(false);

/// Waits for both signals in a separate thread. Call it before other threads start: they must not receive the signals
/// instead.
pub fn watch() {
    #[cfg(target_os = "linux")]
    {
        let ignored = ignored();
        let is_heard = |signal: &Signal| ignored & (1 << (*signal as i32 - 1)) == 0;
        let signals: SigSet = [Signal::SIGINT, Signal::SIGTERM].into_iter().filter(is_heard).collect();
        if signals.thread_block().is_err() {
            return;
        }
        std::thread::spawn(move || {
            while let Ok(signal) = signals.wait() {
                let may_stop = signal == Signal::SIGINT && LISTENS.load(Ordering::SeqCst);
                if !may_stop || ASKED.swap(true, Ordering::SeqCst) {
                    end_by(signal, signals);
                }
                crate::output::tell(format_args!("\nStopping; press Ctrl-C again to quit now."));
                crate::study::process::end();
            }
        });
    }
}

/// Ends the process and its programs as if the signal had not been caught: after a program that catches it, a shell
/// continues with the next line of its script.
#[cfg(target_os = "linux")]
fn end_by(signal: Signal, caught: SigSet) -> ! {
    ENDING.store(true, Ordering::SeqCst);
    crate::measure::process_group::end_started_by(std::process::id());
    let _ = caught.thread_unblock().and_then(|()| raise(signal));
    // A signal does not end the first process of a container.
    std::process::exit(128 + signal as i32);
}

/// A bit for each signal that this process was started to ignore, as a shell does for background jobs. The process
/// would receive them anyway, because they are blocked.
#[cfg(target_os = "linux")]
fn ignored() -> u64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    mask.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok()).unwrap_or(0)
}

/// Ends a run that has stopped, after showing and keeping its results.
pub fn end() -> ExitCode {
    let _ = std::io::stdout().flush();
    #[cfg(target_os = "linux")]
    end_by(Signal::SIGINT, SigSet::from_iter([Signal::SIGINT]));
    #[cfg(not(target_os = "linux"))]
    ExitCode::from(130)
}

/// If a signal is ending this process, waits for that: its programs end first, and the error about them must not end
/// this process with another status.
pub fn wait_for_end() {
    while ENDING.load(Ordering::SeqCst) {
        std::thread::park();
    }
}

pub fn is_asked() -> bool {
    ASKED.load(Ordering::SeqCst)
}

/// Whether a run stops by itself on a signal from now on.
pub fn listen(listens: bool) {
    LISTENS.store(listens, Ordering::SeqCst);
}
