//! The progress bar on stderr.

use std::fmt::Display;
use std::io::{self, IsTerminal};
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressFinish, ProgressStyle};

use super::interrupt;
use super::terminal::Terminal;
use crate::report::Table;
use crate::study::{Screen, Stage};

fn style(template: &str) -> ProgressStyle {
    ProgressStyle::with_template(template).expect("the template is valid")
}

fn bar(steps: Option<u64>, template: &str, terminal: &Terminal) -> ProgressBar {
    let target = if terminal.quiet { ProgressDrawTarget::hidden() } else { ProgressDrawTarget::stderr() };
    ProgressBar::with_draw_target(steps, target).with_style(style(template)).with_finish(ProgressFinish::AndClear)
}

/// `bytes` is `None` if the size is unknown.
#[cfg(feature = "fetch")]
pub fn download(name: &str, bytes: Option<u64>, terminal: &Terminal) -> ProgressBar {
    bar(bytes, "{bar:24} {bytes} of {total_bytes} {wide_msg}", terminal).with_message(name.to_owned())
}

const TICK: Duration = Duration::from_secs(1);

/// Shows `what` and the elapsed time. Drop the returned bar before a measurement, because redrawing the bar disturbs
/// measurements.
pub fn spinner(what: impl Into<String>, terminal: &Terminal) -> ProgressBar {
    let bar = bar(None, "{elapsed_precise} {wide_msg}", terminal).with_message(what.into());
    bar.enable_steady_tick(TICK);
    bar
}

pub struct LogLines {
    /// `None` if printing is disabled.
    last: Option<Instant>,
}

impl LogLines {
    const PAUSE: Duration = Duration::from_secs(5);

    pub fn new(terminal: &Terminal) -> Self {
        Self { last: (!terminal.quiet && !io::stderr().is_terminal()).then(Instant::now) }
    }

    pub fn print_if_due(&mut self, line: impl Display) {
        if self.last.is_some_and(|last| last.elapsed() >= Self::PAUSE) {
            crate::output::print_to_stderr(line);
            self.last = Some(Instant::now());
        }
    }
}

const STEPS: u64 = 100;

pub struct OnTerminal<'a> {
    terminal: &'a Terminal,
    bar: ProgressBar,
    /// The title of the current case.
    case: String,
    /// The work of the current case.
    work: u64,
    /// The work of all finished cases.
    done: u64,
    log: LogLines,
    warned: Vec<String>,
    /// Whether this process measures a single case, as one job of a cluster.
    is_job: bool,
}

impl<'a> OnTerminal<'a> {
    pub fn new(terminal: &'a Terminal, is_job: bool) -> Self {
        let bar = spinner("loading scenes", terminal);
        let (case, log) = (String::new(), LogLines::new(terminal));
        Self { terminal, bar, case, work: 0, done: 0, log, warned: vec![], is_job }
    }

    fn log(&mut self, text: &str) {
        let percent = 100 * self.bar.position() / self.bar.length().unwrap_or(0).max(1);
        self.log.print_if_due(format_args!("{percent} %: {text}"));
    }
}

impl Screen for OnTerminal<'_> {
    fn begin(&mut self, work: u64) {
        self.bar.reset();
        self.bar.set_length(work * STEPS);
        self.bar.set_style(style("{bar:24} {percent:>3}% {elapsed_precise}, {eta} left {wide_msg}"));
        if !self.is_job {
            // Do not let the first Ctrl-C end the process at once.
            interrupt::listen(true);
        }
    }

    fn case(&mut self, title: &str, work: u64) {
        if self.is_job {
            self.terminal.print_message(&format!("measuring {title}"));
        }
        self.log(title);
        (self.case, self.work) = (title.into(), work);
        self.bar.set_message(title.to_owned());
        self.bar.enable_steady_tick(TICK);
    }

    fn stage(&mut self, stage: &Stage) {
        let (text, step) = match stage {
            Stage::Build(label) => (format!("building {label}"), 5),
            Stage::Rays(kind) => (format!("generating {kind} rays"), 15),
            Stage::Check(label) => (format!("checking {label}"), 20),
            Stage::Trace(taken, total) => ("timing".into(), 30 + (STEPS - 30) * *taken as u64 / (*total).max(1) as u64),
            Stage::Count => ("counting".into(), STEPS),
        };
        let text = format!("{}: {text}", self.case);
        // Ticks of the bar disturb the timing.
        match stage {
            Stage::Trace(..) => self.bar.disable_steady_tick(),
            _ => self.bar.enable_steady_tick(TICK),
        }
        // The bar must not move back.
        self.bar.set_position(self.bar.position().max(self.done * STEPS + self.work * step));
        self.log(&text);
        self.bar.set_message(text);
    }

    fn done(&mut self) {
        self.done += self.work;
        self.bar.set_position(self.done * STEPS);
    }

    fn is_watched(&self) -> bool {
        self.terminal.is_watched()
    }

    fn is_interrupted(&self) -> bool {
        interrupt::is_asked()
    }

    fn warn(&mut self, warnings: &[String]) {
        for warning in warnings {
            if !self.terminal.quiet && !self.warned.contains(warning) {
                self.bar.suspend(|| crate::output::print_to_stderr(format_args!("warning: {warning}")));
                self.warned.push(warning.clone());
            }
        }
    }

    fn table(&mut self, table: &Table) {
        self.bar.suspend(|| self.terminal.print_results(table));
    }

    fn end(&mut self) {
        self.bar.finish_and_clear();
    }
}

impl Drop for OnTerminal<'_> {
    fn drop(&mut self) {
        interrupt::listen(false);
        self.bar.finish_and_clear();
    }
}
