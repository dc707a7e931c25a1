//! Ctrl-C: a run that measures stops, shows and keeps what there is; all else ends at once, as does that run at the second one.
//! So does everything at SIGTERM: `timeout` and schedulers, which send it, do not wait for what would be shown.

use std::io::Write;
use std::process::ExitCode;
use std::sync::atomic::{AtomicBool, Ordering};

#[cfg(target_os = "linux")]
use nix::sys::signal::{SigSet, Signal, raise};

/// Whether a run stops by itself when it is asked to.
static LISTENS: AtomicBool = AtomicBool::new(false);
static ASKED: AtomicBool = AtomicBool::new(false);

/// Waits for both signals in a thread of its own. To be called before there are others: they must not be interrupted in
/// its place.
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

/// Ends the process with all that it has started, as if nobody had caught the signal: after a program that has, a shell
/// goes on with the next line of its script.
#[cfg(target_os = "linux")]
fn end_by(signal: Signal, caught: SigSet) -> ! {
    crate::measure::process_group::end_started_by(std::process::id());
    let _ = caught.thread_unblock().and_then(|()| raise(signal));
    // The first process of a container is not ended by a signal.
    std::process::exit(128 + signal as i32);
}

/// A bit for each signal that this process was started to ignore, as a shell starts what is to go on in the background:
/// it would be told of them all the same, for they are blocked.
#[cfg(target_os = "linux")]
fn ignored() -> u64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    mask.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok()).unwrap_or(0)
}

/// Ends a run that has stopped and has shown and kept what there is.
pub fn end() -> ExitCode {
    let _ = std::io::stdout().flush();
    #[cfg(target_os = "linux")]
    end_by(Signal::SIGINT, SigSet::from_iter([Signal::SIGINT]));
    #[cfg(not(target_os = "linux"))]
    ExitCode::from(130)
}

pub fn is_asked() -> bool {
    ASKED.load(Ordering::SeqCst)
}

/// From now on a run stops by itself when it is asked to, or no longer does.
pub fn listen(listens: bool) {
    LISTENS.store(listens, Ordering::SeqCst);
}
