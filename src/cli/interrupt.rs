//! Handles Ctrl-C and SIGTERM on Linux.
//!
//! After `listen(true)`, the first Ctrl-C requests a stop and kills the child process that is measuring. A stopped run
//! prints and saves its results. The second Ctrl-C ends the process at once. SIGTERM ends the process at once,
//! because senders of SIGTERM, such as `timeout` and schedulers, do not wait.

use std::io::Write;
use std::process::ExitCode;
use std::sync::atomic::{AtomicBool, Ordering};

#[cfg(target_os = "linux")]
use nix::sys::signal::{SigSet, Signal, raise};

/// Whether the first Ctrl-C requests a stop. Otherwise the first Ctrl-C ends the process at once.
static LISTENS: AtomicBool = AtomicBool::new(false);
static ASKED: AtomicBool = AtomicBool::new(false);
static ENDING: AtomicBool = AtomicBool::new(false);

/// Starts a thread that waits for SIGINT and SIGTERM. Call this function before the process starts other threads. A
/// thread that already runs could receive the signals.
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
                crate::output::print_to_stderr(format_args!("\nStopping; press Ctrl-C again to quit now."));
                crate::study::process::end();
            }
        });
    }
}

/// Ends the programs that this process started. Then ends this process by `signal`. After an ordinary exit, a calling
/// shell script would continue.
#[cfg(target_os = "linux")]
fn end_by(signal: Signal, caught: SigSet) -> ! {
    ENDING.store(true, Ordering::SeqCst);
    crate::measure::process_group::end_started_by(std::process::id());
    let _ = caught.thread_unblock().and_then(|()| raise(signal));
    // The signal does not end the first process of a container.
    std::process::exit(128 + signal as i32);
}

/// The signals that this process ignores, as a mask with one bit per signal. `SigSet::wait` would return an ignored
/// signal, so `watch` excludes ignored signals.
#[cfg(target_os = "linux")]
fn ignored() -> u64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    mask.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok()).unwrap_or(0)
}

/// Ends the process of an interrupted run.
pub fn end() -> ExitCode {
    let _ = std::io::stdout().flush();
    #[cfg(target_os = "linux")]
    end_by(Signal::SIGINT, SigSet::from_iter([Signal::SIGINT]));
    #[cfg(not(target_os = "linux"))]
    ExitCode::from(130)
}

/// If a signal is ending this process, waits forever. The end of a started program can cause an error in the calling
/// thread. This error must not decide the exit status.
pub fn wait_for_end() {
    while ENDING.load(Ordering::SeqCst) {
        std::thread::park();
    }
}

pub fn is_asked() -> bool {
    ASKED.load(Ordering::SeqCst)
}

pub fn listen(listens: bool) {
    LISTENS.store(listens, Ordering::SeqCst);
}
