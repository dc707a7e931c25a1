//! Output to the terminal: streams, colours, widths, tables and notes.

use std::cell::RefCell;
use std::collections::HashSet;
use std::io::{self, IsTerminal, Write};

use clap::ValueEnum;
use comfy_table::Table as Probe;

use crate::escaped::Escaped as _;
use crate::output::{self, print_to_stderr, stdout_is_taken};
use crate::report::number::plural;
use crate::report::{Screen, Table, terminal, wrapped};

/// When to use colour.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum Colour {
    /// On a terminal, unless NO_COLOR is set
    #[default]
    Auto,
    /// Also in files and pipes
    Always,
    /// No colour
    Never,
}

pub struct Terminal {
    screen: Screen,
    /// Whether standard output is a terminal.
    shown: bool,
    pub quiet: bool,
    pub verbose: bool,
    hidden: RefCell<HashSet<String>>,
}

impl Terminal {
    pub fn new(colour: Colour, quiet: bool, verbose: bool) -> Self {
        let shown = io::stdout().is_terminal();
        let no_color = std::env::var_os("NO_COLOR").is_some_and(|value| !value.is_empty());
        let colour = match colour {
            Colour::Auto => shown && !no_color,
            Colour::Always => true,
            Colour::Never => false,
        };
        // Some terminals report a width of zero.
        let width = if shown { Probe::new().width().filter(|&width| width > 0) } else { None };
        Self { screen: Screen { width, colour }, shown, quiet, verbose, hidden: RefCell::default() }
    }

    /// Whether a person may be reading standard output.
    pub fn is_watched(&self) -> bool {
        self.shown && !self.quiet && !stdout_is_taken()
    }

    pub fn print(&self, text: &str) {
        if stdout_is_taken() {
            // Ignore failures, because stderr may be closed.
            let _ = io::stderr().lock().write_all(text.as_bytes());
        } else {
            output::print(text.as_bytes());
        }
    }

    pub fn print_message(&self, sentence: &str) {
        if !self.quiet {
            print_to_stderr(sentence);
        }
    }

    pub fn print_table(&self, table: &Table) {
        let table = if self.verbose { table.clone() } else { table.clone().without_details() };
        let table = terminal::with_short_names(table);
        self.print(&(terminal::table(&table, self.screen) + "\n"));
    }

    /// Prints a table of measurements. The notes of the table are printed only with `verbose`.
    pub fn print_results(&self, table: &Table) {
        if self.verbose {
            return self.print_table(table);
        }
        let mut table = terminal::with_short_names(table.clone().without_details());
        self.print_notes(std::mem::take(&mut table.notes));
        self.print(&(terminal::table(&table, self.screen) + "\n"));
    }

    pub fn print_notes(&self, notes: impl IntoIterator<Item = impl Into<String>>) {
        let notes = notes.into_iter().map(Into::into);
        if self.verbose { self.print_lines(notes) } else { self.hidden.borrow_mut().extend(notes) }
    }

    pub fn print_note_count(&self) {
        let hidden = self.hidden.borrow().len();
        if hidden > 0 {
            let them = if hidden == 1 { "it" } else { "them" };
            self.print(&format!("{}: --verbose shows {them}\n", plural(hidden, "note")));
        }
    }

    pub fn print_lines(&self, lines: impl IntoIterator<Item = impl AsRef<str>>) {
        let width = usize::from(self.screen.width.unwrap_or(120));
        let lines = lines.into_iter().flat_map(|line| wrapped(&line.as_ref().escaped().to_string(), width));
        self.print(&lines.map(|line| line + "\n").collect::<String>());
    }
}
