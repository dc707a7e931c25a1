//! Detects a build that takes too long. The build is not interrupted.

use std::sync::mpsc::{RecvTimeoutError, Sender, channel};
use std::thread;
use std::time::Duration;

/// The default value has no limit and no thread.
#[derive(Default)]
pub struct BuildWatch {
    /// Sends the index of a structure before a build. Sends `None` after the build.
    sender: Option<Sender<Option<usize>>>,
}

impl BuildWatch {
    /// Calls `on_limit` with the index of the structure if a build takes longer than `limit`.
    pub fn new(limit: Duration, on_limit: impl Fn(usize) + Send + 'static) -> Self {
        let (sender, receiver) = channel::<Option<usize>>();
        thread::spawn(move || {
            while let Ok(message) = receiver.recv() {
                let Some(structure) = message else { continue };
                if receiver.recv_timeout(limit) == Err(RecvTimeoutError::Timeout) {
                    on_limit(structure);
                }
            }
        });
        Self { sender: Some(sender) }
    }

    pub fn during<R>(&self, structure: usize, build: impl FnOnce() -> R) -> R {
        // Sending fails only if `on_limit` panicked.
        let send = |what| {
            let _ = self.sender.as_ref().map(|sender| sender.send(what));
        };
        send(Some(structure));
        let built = build();
        send(None);
        built
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_build_beyond_its_limit_is_told_once_and_a_short_one_never() {
        let (sender, reports) = channel();
        let watch = BuildWatch::new(Duration::from_millis(100), move |structure| sender.send(structure).unwrap());
        watch.during(3, || ());
        assert_eq!(watch.during(7, || reports.recv_timeout(Duration::from_secs(60))), Ok(7));
        watch.during(8, || ());
        drop(watch);
        assert!(reports.recv_timeout(Duration::from_secs(60)).is_err());
        assert_eq!(BuildWatch::default().during(1, || 5), 5);
    }
}
