//! `report`: what runs have measured as a page, Markdown and tidy data.
//!
//! Each study makes its [`Report`](crate::report::Report) of what was measured; a [`Document`] frames the reports, and
//! every form is written from that. What no run has measured is named with its command.

mod document;
mod files;
mod html;
mod markdown;
mod pictures;
pub mod results;
mod run_error;
mod runs;
mod sections;
#[cfg(test)]
mod tests;

pub use document::{Answer, Document, Headline, Section};
pub use files::files;
pub use html::page;
pub use pictures::{draw, left_out};
pub use run_error::RunError;
pub use runs::{Runs, StudyRun};
pub use sections::document;
