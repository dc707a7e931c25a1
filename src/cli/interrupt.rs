//! Ctrl-C: a run that measures stops, shows and keeps what there is; all else ends at once, as does that run at the second one.

use std::sync::atomic::{AtomicBool, Ordering};

/// Exit status of what was interrupted, as shells have it.
pub const STATUS: u8 = 130;

/// Whether a run stops by itself when it is asked to.
static LISTENS: AtomicBool = AtomicBool::new(false);
static ASKED: AtomicBool = AtomicBool::new(false);

/// Waits for Ctrl-C in a thread of its own. To be called before there are others: they must not be interrupted in its place.
pub fn watch() {
    #[cfg(target_os = "linux")]
    {
        use nix::sys::signal::{SigSet, Signal};
        let mut signals = SigSet::empty();
        signals.add(Signal::SIGINT);
        if signals.thread_block().is_err() {
            return;
        }
        std::thread::spawn(move || {
            while signals.wait().is_ok() {
                if !LISTENS.load(Ordering::SeqCst) || ASKED.swap(true, Ordering::SeqCst) {
                    crate::measure::process_group::end_started_by(std::process::id());
                    std::process::exit(STATUS.into());
                }
                crate::output::tell(format_args!("\nStops; Ctrl-C once more ends at once."));
                crate::study::process::end();
            }
        });
    }
}

/// Whether the run is to stop.
pub fn is_asked() -> bool {
    ASKED.load(Ordering::SeqCst)
}

/// A run that stops when it is asked to, as long as this is kept.
pub struct Listening;

impl Listening {
    pub fn begin() -> Self {
        LISTENS.store(true, Ordering::SeqCst);
        Self
    }
}

impl Drop for Listening {
    fn drop(&mut self) {
        LISTENS.store(false, Ordering::SeqCst);
    }
}
