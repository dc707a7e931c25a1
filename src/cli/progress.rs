//! The progress bar: on stderr, drawn only when a study says what it does, which is never inside a timed region.

use std::io::IsTerminal;
use std::sync::mpsc::{RecvTimeoutError, Sender, channel};
use std::thread;
use std::time::{Duration, Instant};
use std::{fmt, io};

use indicatif::{HumanDuration, ProgressBar, ProgressDrawTarget, ProgressState, ProgressStyle};

use super::interrupt::{self, Listening};
use super::terminal::Terminal;
use crate::report::Table;
use crate::study::{Screen, Stage};
use crate::validate::LIMIT;

/// A bar of so many steps, if that is known.
fn bar(steps: Option<u64>, terminal: &Terminal) -> ProgressBar {
    let target = if terminal.quiet { ProgressDrawTarget::hidden() } else { ProgressDrawTarget::stderr() };
    ProgressBar::with_draw_target(steps, target)
}

fn style(template: &str) -> ProgressStyle {
    ProgressStyle::with_template(template).expect("the template is valid")
}

/// The bar of a download of `bytes`, if that is known; told how many there are.
#[cfg(feature = "fetch")]
pub fn download(name: &str, bytes: Option<u64>, terminal: &Terminal) -> ProgressBar {
    let bar = bar(bytes, terminal).with_style(style("{bar:24} {bytes} of {total_bytes} {wide_msg}"));
    bar.set_message(name.to_owned());
    bar
}

/// How often what takes long is seen to go on.
const TICK: Duration = Duration::from_secs(1);

/// Says what is done and for how long already, until it is dropped; for work that nobody times.
pub struct Waiting(ProgressBar);

impl Waiting {
    pub fn show(what: String, terminal: &Terminal) -> Self {
        let bar = bar(None, terminal).with_style(style("{elapsed_precise} {wide_msg}"));
        bar.set_message(what);
        bar.enable_steady_tick(TICK);
        Self(bar)
    }

    /// Now something else is done.
    pub fn says(&self, what: String) {
        self.0.set_message(what);
    }
}

impl Drop for Waiting {
    fn drop(&mut self) {
        self.0.finish_and_clear();
    }
}

/// How often a log, which shows no bar, is told how far a run has come.
const LINE: Duration = Duration::from_secs(5);

/// Steps of the bar for each unit of work.
const STEPS: u64 = 100;

/// A thread that calls `tell` with what it was told last, if nothing else comes for `limit`; it sleeps otherwise. `None` is nothing
/// to wait for.
fn watch(limit: Duration, tell: impl Fn(&str) + Send + 'static) -> Sender<Option<String>> {
    let (sender, receiver) = channel::<Option<String>>();
    thread::spawn(move || {
        let mut waiting: Option<String> = None;
        loop {
            let next = match waiting.take() {
                None => receiver.recv().map_err(|_| RecvTimeoutError::Disconnected),
                Some(stage) => receiver.recv_timeout(limit).inspect_err(|error| {
                    if *error == RecvTimeoutError::Timeout {
                        tell(&stage);
                    }
                }),
            };
            match next {
                Ok(stage) => waiting = stage,
                Err(RecvTimeoutError::Timeout) => {}
                Err(RecvTimeoutError::Disconnected) => return,
            }
        }
    });
    sender
}

/// How far a run over several scenes has come.
pub struct Progress {
    bar: ProgressBar,
    /// Told what each structure is asked for, and that it has answered.
    watch: Sender<Option<String>>,
    /// Whether it was told of something that has not ended.
    watched: bool,
    scene: String,
    /// What the scene is of all work, and what was done before it.
    work: u64,
    done: u64,
    /// Farthest step of this scene: structures are built again between samples.
    step: u64,
    /// When the last line was written where there is no bar; nothing where there is one, or nothing is to be shown.
    logged: Option<Instant>,
    /// Warnings that were shown.
    warned: Vec<String>,
    quiet: bool,
}

impl Progress {
    pub fn over(work: u64, terminal: &Terminal) -> Self {
        let left = |state: &ProgressState, out: &mut dyn fmt::Write| {
            // Long cases and short ones follow each other: what all of them took says more than the last seconds.
            let (done, all) = (state.pos(), state.len().unwrap_or(0));
            if done > STEPS {
                let left = state.elapsed().mul_f64(all.saturating_sub(done) as f64 / done as f64);
                let _ = write!(out, ", {:#} left", HumanDuration(left));
            }
        };
        let style = style("{bar:24} {percent:>3}% {elapsed_precise}{left} {wide_msg}").with_key("left", left);
        let bar = bar(Some(work * STEPS), terminal).with_style(style);
        let own = bar.clone();
        let watch = watch(LIMIT, move |stage| {
            let limit = LIMIT.as_secs();
            let advice =
                "if it hangs, end this run; `sahara validate` gives it up after --limit seconds and names the ray";
            own.suspend(|| crate::output::tell(format_args!("{stage} for more than {limit} s: {advice}")));
        });
        Self {
            bar,
            watch,
            watched: false,
            scene: String::new(),
            work: 0,
            done: 0,
            step: 0,
            logged: (!terminal.quiet && !io::stderr().is_terminal()).then(Instant::now),
            warned: vec![],
            quiet: terminal.quiet,
        }
    }

    /// The next scene begins, so much of all work.
    pub fn scene(&mut self, name: &str, work: u64) {
        (self.scene, self.work) = (name.into(), work);
        self.bar.set_message(name.to_owned());
        // A process of its own loads it now.
        self.bar.enable_steady_tick(TICK);
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
            Stage::Count => ("is counted".into(), STEPS),
        };
        let text = format!("{} {text}", self.scene);
        // Nothing is drawn while samples are taken.
        match stage {
            Stage::Trace(..) => self.bar.disable_steady_tick(),
            _ => self.bar.enable_steady_tick(TICK),
        }
        // Between samples the watch is not woken.
        match stage {
            Stage::Build(_) | Stage::Check(_) => self.watched(Some(&text)),
            Stage::Rays(_) | Stage::Trace(..) | Stage::Count => self.watched(None),
        }
        self.step = self.step.max(step);
        self.bar.set_position(self.done * STEPS + self.work * self.step);
        self.log(&text);
        self.bar.set_message(text);
    }

    fn log(&mut self, text: &str) {
        if self.logged.is_some_and(|last| last.elapsed() >= LINE) {
            let percent = 100 * self.bar.position() / self.bar.length().unwrap_or(0).max(1);
            crate::output::tell(format_args!("{percent} %: {text}"));
            self.logged = Some(Instant::now());
        }
    }

    fn watched(&mut self, stage: Option<&str>) {
        if stage.is_some() || self.watched {
            self.watched = stage.is_some();
            // The watch listens as long as this lives.
            let _ = self.watch.send(stage.map(str::to_owned));
        }
    }

    /// The scene is done.
    pub fn scene_done(&mut self) {
        self.watched(None);
        self.done += self.work;
        self.step = 0;
        self.bar.set_position(self.done * STEPS);
    }

    /// Shows what spoilt the run, each sentence once, unless nothing is to be shown beside results.
    pub fn warn<'a>(&mut self, warnings: impl IntoIterator<Item = &'a String>) {
        for warning in warnings {
            if !self.quiet && !self.warned.contains(warning) {
                self.bar.suspend(|| crate::output::tell(format_args!("warning: {warning}")));
                self.warned.push(warning.clone());
            }
        }
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

/// The progress bar and the tables of a study.
pub struct OnTerminal<'a> {
    terminal: &'a Terminal,
    /// Until it is known what is measured.
    loading: Option<Waiting>,
    progress: Option<Progress>,
    /// Whether it shows a job: one case, of which there is nothing to show or keep before it is measured.
    is_job: bool,
    /// While a run measures: all else is ended by Ctrl-C at once.
    listening: Option<Listening>,
}

impl<'a> OnTerminal<'a> {
    pub fn new(terminal: &'a Terminal) -> Self {
        let loading = Some(Waiting::show("loads scenes".into(), terminal));
        Self { terminal, loading, progress: None, is_job: false, listening: None }
    }

    /// That of a job, which says what it measures in a line that is there in a log as well.
    pub fn of_job(terminal: &'a Terminal) -> Self {
        Self { is_job: true, ..Self::new(terminal) }
    }
}

impl Screen for OnTerminal<'_> {
    fn begin(&mut self, work: u64) {
        self.loading = None;
        self.progress = Some(Progress::over(work, self.terminal));
        if !self.is_job {
            self.listening.get_or_insert_with(Listening::begin);
        }
    }

    fn case(&mut self, title: &str, work: u64) {
        if self.is_job {
            self.terminal.tell(&format!("measures {title}"));
        }
        self.progress.iter_mut().for_each(|progress| progress.scene(title, work));
    }

    fn stage(&mut self, stage: &Stage) {
        self.progress.iter_mut().for_each(|progress| progress.stage(stage));
    }

    fn done(&mut self) {
        self.progress.iter_mut().for_each(Progress::scene_done);
    }

    fn is_watched(&self) -> bool {
        self.terminal.is_watched()
    }

    fn is_interrupted(&self) -> bool {
        interrupt::is_asked()
    }

    fn warn(&mut self, warnings: &[String]) {
        self.progress.iter_mut().for_each(|progress| progress.warn(warnings));
    }

    fn table(&mut self, table: &Table) {
        let print = || self.terminal.print_table(table);
        self.progress.as_ref().map_or_else(print, |progress| progress.aside(print));
    }

    fn end(&mut self) {
        self.progress.take().into_iter().for_each(Progress::finish);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_not_followed_by_anything_is_told_once() {
        let (told, heard) = channel();
        let watch = watch(Duration::from_millis(1), move |stage| told.send(stage.to_owned()).unwrap());
        watch.send(None).unwrap();
        watch.send(Some("checks a".into())).unwrap();
        assert_eq!(heard.recv().as_deref(), Ok("checks a"));
        drop(watch);
        assert_eq!(heard.recv().ok(), None);
    }
}
