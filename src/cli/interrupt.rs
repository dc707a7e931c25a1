//! Ctrl-C and SIGTERM. At the first Ctrl-C, a run that measures stops, and prints and saves its results. At the second
//! Ctrl-C, it ends at once. All other commands end at the first Ctrl-C. SIGTERM ends every command at once, because its
//! senders (`timeout`, schedulers) do not wait.

use std::io::Write;
use std::process::ExitCode;
use std::sync::atomic::{AtomicBool, Ordering};

#[cfg(target_os = "linux")]
use nix::sys::signal::{SigSet, Signal, raise};

/// Whether Ctrl-C asks a run to stop instead of ending the process at once.
static LISTENS: AtomicBool = AtomicBool::new(false);
static ASKED: AtomicBool = AtomicBool::new(false);
/// Whether a signal is ending this process.
static ENDING: AtomicBool = AtomicBool::new(false);

/// Starts a thread that waits for SIGINT and SIGTERM. Call it first, because earlier threads might receive the signals.
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

/// Ends the programs that this process has started, then stops catching `signal` and sends it to this process. A shell
/// that runs a script ends the script only if a signal ended the command.
#[cfg(target_os = "linux")]
fn end_by(signal: Signal, caught: SigSet) -> ! {
    ENDING.store(true, Ordering::SeqCst);
    crate::measure::process_group::end_started_by(std::process::id());
    let _ = caught.thread_unblock().and_then(|()| raise(signal));
    // The first process of a container survives the signal: exit.
    std::process::exit(128 + signal as i32);
}

/// The signals that this process ignores since its start, one bit per signal. For example, shells start background jobs
/// that ignore SIGINT. `watch` must not wait for these signals: its thread would receive them although they are
/// ignored.
#[cfg(target_os = "linux")]
fn ignored() -> u64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    mask.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok()).unwrap_or(0)
}

/// Ends the process after a stopped run has printed and saved its results.
pub fn end() -> ExitCode {
    let _ = std::io::stdout().flush();
    #[cfg(target_os = "linux")]
    end_by(Signal::SIGINT, SigSet::from_iter([Signal::SIGINT]));
    #[cfg(not(target_os = "linux"))]
    ExitCode::from(130)
}

/// Waits forever if a signal is ending this process. The thread of [`watch`] first ends the started programs, which
/// causes errors here. These errors must not decide the exit status.
pub fn wait_for_end() {
    while ENDING.load(Ordering::SeqCst) {
        std::thread::park();
    }
}

pub fn is_asked() -> bool {
    ASKED.load(Ordering::SeqCst)
}

/// Sets whether the first Ctrl-C stops a run (`listens` is true) or ends the process at once.
pub fn listen(listens: bool) {
    LISTENS.store(listens, Ordering::SeqCst);
}
