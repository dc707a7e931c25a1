//! Where output goes, and what it may look like.

use std::cell::RefCell;
use std::io::{self, IsTerminal, Write};

use clap::ValueEnum;
use comfy_table::Table as Probe;

use crate::escaped::Escaped as _;
use crate::output::{self, stdout_is_taken, tell};
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
    /// Whether somebody looks at standard output.
    shown: bool,
    /// Whether progress is hidden.
    pub quiet: bool,
    /// Whether tables are printed with all their columns and notes.
    pub verbose: bool,
    /// Notes that were not printed, each once.
    hidden: RefCell<Vec<String>>,
}

impl Terminal {
    pub fn new(colour: Colour, quiet: bool) -> Self {
        let shown = io::stdout().is_terminal();
        let no_color = std::env::var_os("NO_COLOR").is_some_and(|value| !value.is_empty());
        let colour = match colour {
            Colour::Auto => shown && !no_color,
            Colour::Always => true,
            Colour::Never => false,
        };
        // Some terminals do not know their width, and say zero.
        let width = if shown { Probe::new().width().filter(|&width| width > 0) } else { None };
        Self { screen: Screen { width, colour }, shown, quiet, verbose: false, hidden: RefCell::default() }
    }

    /// The same, which prints tables with all their columns and notes if `verbose`.
    pub fn verbose(self, verbose: bool) -> Self {
        Self { verbose, ..self }
    }

    /// Whether somebody looks who may want to see what is not final.
    pub fn is_watched(&self) -> bool {
        self.shown && !self.quiet && !stdout_is_taken()
    }

    /// Prints text as it is; to standard error where a result goes to standard output.
    pub fn print(&self, text: &str) {
        if stdout_is_taken() {
            // As with all that goes there, nothing depends on its reader.
            let _ = io::stderr().lock().write_all(text.as_bytes());
        } else {
            output::print(text.as_bytes());
        }
    }

    /// Says on standard error what is no result, unless progress is left out.
    pub fn tell(&self, sentence: &str) {
        if !self.quiet {
            tell(sentence);
        }
    }

    /// Prints a table with its notes, but for columns in which no row says anything, and a blank line after it.
    pub fn print_table(&self, table: &Table) {
        let table = if self.verbose { table.clone() } else { table.clone().without_details() };
        let table = terminal::with_short_names(table);
        self.print(&(terminal::table(&table, self.screen) + "\n"));
    }

    /// Prints a table of measurements: its notes are shown as [`print_notes`](Self::print_notes) shows them.
    pub fn print_results(&self, table: &Table) {
        if self.verbose {
            return self.print_table(table);
        }
        let mut table = terminal::with_short_names(table.clone().without_details());
        self.hide(std::mem::take(&mut table.notes));
        self.print(&(terminal::table(&table, self.screen) + "\n"));
    }

    /// Prints what explains results if `verbose`; else [`print_note_count`](Self::print_note_count) says that it is there.
    pub fn print_notes(&self, notes: impl IntoIterator<Item = String>) {
        let notes: Vec<String> = notes.into_iter().collect();
        if self.verbose { self.print_lines(&notes) } else { self.hide(notes) }
    }

    fn hide(&self, notes: Vec<String>) {
        let mut hidden = self.hidden.borrow_mut();
        for note in notes {
            if !hidden.contains(&note) {
                hidden.push(note);
            }
        }
    }

    /// Says how many notes were not printed, if any.
    pub fn print_note_count(&self) {
        match self.hidden.borrow().len() {
            0 => {}
            n => {
                self.print(&format!("{}: --verbose shows {}\n", plural(n, "note"), if n == 1 { "it" } else { "them" }))
            }
        }
    }

    /// Prints lines of text, broken where the screen ends.
    pub fn print_lines(&self, lines: &[String]) {
        let width = usize::from(self.screen.width.unwrap_or(120));
        let lines = lines.iter().flat_map(|line| wrapped(&line.escaped().to_string(), width));
        self.print(&lines.map(|line| line + "\n").collect::<String>());
    }
}
