//! The progress bar: on stderr, drawn only when a study says what it does, which is never inside a timed region.

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

use super::terminal::Terminal;
use crate::study::Stage;

/// The bar of a download of `bytes`, if that is known; told how many there are.
#[cfg(feature = "fetch")]
pub fn download(name: &str, bytes: Option<u64>, terminal: &Terminal) -> ProgressBar {
    let target = if terminal.quiet { ProgressDrawTarget::hidden() } else { ProgressDrawTarget::stderr() };
    let bar = ProgressBar::with_draw_target(bytes, target);
    let style = ProgressStyle::with_template("{bar:24} {bytes} of {total_bytes} {wide_msg}");
    bar.set_style(style.expect("the template is valid"));
    bar.set_message(name.to_owned());
    bar
}

/// Steps of the bar for each scene.
const STEPS: u64 = 100;

/// How far a run over several scenes has come.
pub struct Progress {
    bar: ProgressBar,
    scene: String,
    scenes_done: u64,
}

impl Progress {
    pub fn over(scenes: usize, terminal: &Terminal) -> Self {
        let target = if terminal.quiet { ProgressDrawTarget::hidden() } else { ProgressDrawTarget::stderr() };
        let bar = ProgressBar::with_draw_target(Some(scenes as u64 * STEPS), target);
        let style = ProgressStyle::with_template("{bar:24} {percent:>3}% {elapsed:>4} {wide_msg}");
        bar.set_style(style.expect("the template is valid"));
        Self { bar, scene: String::new(), scenes_done: 0 }
    }

    /// The next scene begins.
    pub fn scene(&mut self, name: &str) {
        self.scene = name.into();
        self.bar.set_message(name.to_owned());
        self.bar.tick();
    }

    /// A scene says what it does.
    pub fn stage(&mut self, stage: &Stage) {
        let (text, step) = match stage {
            Stage::Build(label) => (format!("builds {label}"), 5),
            Stage::Rays(kind) => (format!("makes {kind} rays"), 15),
            Stage::Check(label) => (format!("checks {label}"), 20),
            Stage::Trace(taken, total) => {
                ("is timed".into(), 30 + (STEPS - 30) * *taken as u64 / (*total).max(1) as u64)
            }
        };
        self.bar.set_message(format!("{} {text}", self.scene));
        self.bar.set_position(self.scenes_done * STEPS + step);
    }

    /// The scene is done.
    pub fn scene_done(&mut self) {
        self.scenes_done += 1;
        self.bar.set_position(self.scenes_done * STEPS);
    }

    /// Takes the bar away while `print` writes, so that the two do not mix on a terminal.
    pub fn aside<R>(&self, print: impl FnOnce() -> R) -> R {
        self.bar.suspend(print)
    }

    /// The whole run is over: takes the bar away.
    pub fn finish(self) {
        self.bar.finish_and_clear();
    }
}
