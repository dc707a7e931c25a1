//! `report`: what runs have measured as a page, Markdown and tidy data.
//!
//! Runs become a document of text, tables and figures by pure functions; every form is written from that. What no run
//! has measured is named with its command.

mod content;
mod files;
mod html;
mod machines;
mod markdown;
mod pictures;
mod planned;
pub mod results;
mod run_error;
mod runs;
mod sections;
#[cfg(test)]
mod tests;

pub use files::files;
pub use html::page;
pub use machines::{Machine, OfMachine};
pub use pictures::{draw, left_out};
pub use run_error::RunError;
pub use runs::{Runs, Source};
pub use sections::document;
